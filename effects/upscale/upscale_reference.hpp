// SPDX-License-Identifier: MIT
#pragma once
// EASU in double precision (AMD, "FidelityFX Super Resolution 1.0", 2021, edge-adaptive spatial upsampling): twelve
// pixels by a kernel near Lanczos', turned and stretched along the edge that their luma shows, within the span of the
// nearest four. Alpha, of which the published code has none, is bilinear.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/upscale.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"

namespace darkroom {

/// Where the middle of pixel `i` of `large` lies among `small`: behind the middle of pixel `base` by a part of one.
struct UpscalePlace {
    std::int64_t base = 0;
    double part = 0;
};
inline UpscalePlace upscale_place(std::int64_t i, std::int64_t small, std::int64_t large) {
    const std::int64_t above = (2 * i + 1) * small - large, below = 2 * large;
    const std::int64_t base = above < 0 ? -((below - 1 - above) / below) : above / below;
    return {base, static_cast<double>(above - base * below) / static_cast<double>(below)};
}

class UpscaleReference {
  public:
    UpscaleReference(const Upscale& upscale, const ReferenceImage& picture) : upscale_(upscale), picture_(picture) {}

    Rgba at(const UpscalePlace& x, const UpscalePlace& y) const {
        // Rows of the twelve: two pixels, four, four, two.
        constexpr std::array<std::array<int, 2>, 12> taps{
            {{0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {2, 0}, {-1, 1}, {0, 1}, {1, 1}, {2, 1}, {0, 2}, {1, 2}}};
        const Shape shape = shape_of(x, y);
        Rgba sum{0, 0, 0, 0};
        double weights = 0;
        for (const auto& [i, j] : taps) {
            const double dx = i - x.part, dy = j - y.part;
            const double u = (dx * shape.dx + dy * shape.dy) * shape.along,
                         v = (dy * shape.dx - dx * shape.dy) * shape.across;
            const double weight = shape.weight(u * u + v * v);
            const Rgba c = pixel(x.base + i, y.base + j);
            sum = {sum.r + weight * c.r, sum.g + weight * c.g, sum.b + weight * c.b, 0};
            weights += weight;
        }
        const Rgba f = pixel(x.base, y.base), g = pixel(x.base + 1, y.base), j = pixel(x.base, y.base + 1),
                   k = pixel(x.base + 1, y.base + 1);
        Rgba out;
        for (double Rgba::*const c : {&Rgba::r, &Rgba::g, &Rgba::b}) {
            const auto [least, most] = std::minmax({f.*c, g.*c, j.*c, k.*c});
            out.*c = std::clamp(sum.*c / weights, least, most);
        }
        out.a = std::lerp(std::lerp(f.a, g.a, x.part), std::lerp(j.a, k.a, x.part), y.part);
        return out;
    }

  private:
    /// The direction across which luma changes, how much the kernel shrinks along and grows across it, and its form.
    struct Shape {
        double dx = 1, dy = 0, along = 1, across = 1, lobe = 0.5;
        [[nodiscard]] double weight(double distance_squared) const {
            const double d = std::min(distance_squared, 1 / lobe), base = 0.4 * d - 1, window = lobe * d - 1;
            return (25.0 / 16 * base * base - (25.0 / 16 - 1)) * window * window;
        }
    };

    Rgba pixel(std::int64_t x, std::int64_t y) const {
        const Rgba& c = picture_.clamped(x, y);
        return {finite_reference(c.r), finite_reference(c.g), finite_reference(c.b), finite_reference(c.a)};
    }
    double luma(std::int64_t x, std::int64_t y) const {
        const Rgba c = pixel(x, y);
        return 0.5 * c.b + (0.5 * c.r + c.g);
    }

    Shape shape_of(const UpscalePlace& x, const UpscalePlace& y) const {
        double dx = 0, dy = 0, length = 0;
        for (const int j : {0, 1})
            for (const int i : {0, 1}) {
                const double weight = (i == 0 ? 1 - x.part : x.part) * (j == 0 ? 1 - y.part : y.part);
                const auto near = [&](int u, int v) { return luma(x.base + i + u, y.base + j + v); };
                const double own = near(0, 0), left = near(-1, 0), right = near(1, 0), up = near(0, -1),
                             down = near(0, 1);
                const auto straight = [](double before, double here, double behind) {
                    const double most = std::max(std::abs(behind - here), std::abs(here - before));
                    const double part = most > 0 ? std::min(std::abs(behind - before) / most, 1.0) : 0;
                    return part * part;
                };
                dx += (right - left) * weight;
                dy += (down - up) * weight;
                length += (straight(left, own, right) + straight(up, own, down)) * weight;
            }
        Shape out;
        if (dx * dx + dy * dy >= 1.0 / 32768) {
            const double norm = std::hypot(dx, dy);
            out.dx = dx / norm, out.dy = dy / norm;
        } else {
            out.dx = 1, out.dy = dy;
        }
        length = 0.25 * length * length * double{upscale_.adaption};
        const double stretch = (out.dx * out.dx + out.dy * out.dy) / std::max(std::abs(out.dx), std::abs(out.dy));
        out.along = 1 + (stretch - 1) * length;
        out.across = 1 - 0.5 * length;
        out.lobe = 0.5 + (0.25 - 0.04 - 0.5) * length;
        return out;
    }

    const Upscale& upscale_;
    const ReferenceImage& picture_;
};

inline ReferenceImage upscale_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    if (input.output_width == 0 || (picture.width == input.output_width && picture.height == input.output_height))
        return picture;
    const UpscaleReference upscaled(*static_cast<const Upscale*>(parameters), picture);
    ReferenceImage out(input.output_width, input.output_height);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) =
                upscaled.at(upscale_place(x, picture.width, out.width), upscale_place(y, picture.height, out.height));
    return out;
}

}  // namespace darkroom
