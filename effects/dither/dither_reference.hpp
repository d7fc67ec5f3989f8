// SPDX-License-Identifier: MIT
#pragma once
// Dither in double precision, and the tile that the GPU reads too: with the rank r of a texel in (0, 1),
// t = 2r - 1, n = sign(t)(1 - sqrt(1 - |t|)), c' = c + n * min(intensity / 2, c, 1 - c) for the unrounded mean. For the
// rounded one n is the quantile of t in the sum of two uniform noises, one step of intensity / 2 wide and at most as
// wide: Lipshitz, Wannamaker and Vanderkooy, "Quantization and Dither: A Theoretical Survey", 1992.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <darkroom/effects/dither.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline constexpr std::uint32_t dither_tile_size = 64;

/// Triangular noise in (-1, 1): red, green, blue and nothing.
using DitherTexel = std::array<float, 4>;

/// Row-major.
[[nodiscard]] const std::array<DitherTexel, dither_tile_size * dither_tile_size>& dither_tile();

struct DitherOffset {
    std::uint32_t x = 0, y = 0;
};

/// The next point of the R2 sequence (Martin Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018)
/// every frame, in texels, while time runs.
[[nodiscard]] inline DitherOffset dither_offset(double time, std::uint64_t frame_index) {
    const std::uint32_t frame = time > 0.0 ? static_cast<std::uint32_t>(frame_index) : 0;
    return {(frame * 0xC13FA9A9u) >> 26u, (frame * 0x91E10DA6u) >> 26u};
}

inline ReferenceImage dither_image_reference(const void* parameters, const ReferenceInput& input) {
    const Dither& dither = *static_cast<const Dither*>(parameters);
    const double widest = dither.intensity / 2.0;
    const DitherOffset offset = dither.moves ? dither_offset(input.time, input.frame_index) : DitherOffset{};
    const auto add = [&](double v, double noise) {
        const double room = std::min(v, 1.0 - v);
        if (dither.ends == DitherEnds::Unrounded) return v + noise * std::max(std::min(widest, room), 0.0);
        if (room < 0 || widest == 0) return v;
        const double code = std::min(widest, std::max(room, 1 / 255.0));
        // Both halves of the trapezoid: a plateau of height 1 up to 1/2 - second, then a slope down to 1/2 + second.
        const double second = std::min(room / code, 0.5), t = 1 - std::pow(1 - std::abs(noise), 2);
        const double found = t <= 1 - 2 * second ? t / 2 : 0.5 + second - std::sqrt(2 * second * (1 - t));
        return std::clamp(v + code * std::copysign(found, noise), 0.0, 1.0);
    };
    ReferenceImage out = *input.picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const std::size_t row = (y + offset.y) % dither_tile_size;
            const DitherTexel& noise = dither_tile()[row * dither_tile_size + (x + offset.x) % dither_tile_size];
            Rgba& color = out.at(x, y);
            color = {add(color.r, noise[0]), add(color.g, noise[1]), add(color.b, noise[2]), color.a};
        }
    }
    return out;
}

}  // namespace darkroom
