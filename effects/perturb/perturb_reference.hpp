// SPDX-License-Identifier: MIT
#pragma once
// Perturbation in double precision. With s the strength, t the phases, d_x and d_y the size of a pixel in uv, of one of
// a picture of 1080 lines where sizes are parts of the height:
//     u' = u + a d_x (s.x sin 2 pi (s.z v + t.x) + ring + image)
//     v' = v + a d_y (s.y sin 2 pi (s.w u + t.y) + ring + image)
// The sum of sines, and an image of displacements: Jason L. Mitchell, Marwan Y. Ansari and Evan Hart, "Advanced Image
// Processing with DirectX 9 Pixel Shaders", ShaderX2, 2003. The ring at radius R is a bump of half-width w that moves
// what is seen toward its centre: cos^2(pi (r - R) / 2 w), r in heights of the picture.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/perturb.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "shared/sample_reference.hpp"
#include "shared/warp_grid_reference.hpp"

namespace darkroom {

struct PerturbShift {
    double x = 0, y = 0;  ///< in pixels
};

/// Of the picture seen at (u, v), for one of width x height.
inline PerturbShift perturb_shift(const Perturb& p, const PerturbFrame& frame, double u, double v, double width,
                                  double height, const ReferenceImage* distortion) {
    constexpr double turn = 2 * std::numbers::pi;
    PerturbShift shift{double{p.strength.x} * std::sin(turn * (double{p.strength.z} * v + double{frame.phase_x})),
                       double{p.strength.y} * std::sin(turn * (double{p.strength.w} * u + double{frame.phase_y}))};
    const double x = (u - double{p.ring_center.x}) * width / height, y = v - double{p.ring_center.y};
    const double radius = std::hypot(x, y);
    const double place = (radius - double{frame.ring_radius}) / double{p.ring_width};
    if (std::abs(place) < 1 && radius > 0) {
        const double bump = std::pow(std::cos(std::numbers::pi / 2 * place), 2) * double{frame.ring_amplitude};
        shift = {shift.x - bump * x / radius, shift.y - bump * y / radius};
    }
    if (distortion != nullptr) {
        // Repeats, with linear interpolation across the seam.
        const auto wrapped = [](std::int64_t i, std::uint32_t n) {
            return static_cast<std::uint32_t>((i % n + n) % n);
        };
        const double column = (u + double{frame.phase_x}) * distortion->width - 0.5;
        const double row = (v + double{frame.phase_y}) * distortion->height - 0.5;
        const auto left = static_cast<std::int64_t>(std::floor(column)),
                   top = static_cast<std::int64_t>(std::floor(row));
        const double fx = column - std::floor(column), fy = row - std::floor(row);
        for (int i = 0; i < 4; ++i) {
            const Rgba& texel =
                distortion->at(wrapped(left + i % 2, distortion->width), wrapped(top + i / 2, distortion->height));
            const double weight = (i % 2 == 0 ? 1 - fx : fx) * (i / 2 == 0 ? 1 - fy : fy);
            shift.x += weight * double{p.distortion_strength} * (2 * texel.r - 1);
            shift.y += weight * double{p.distortion_strength} * (2 * texel.g - 1);
        }
    }
    const double scale = double{p.amount} * pixels_of(p.reach, 1, height);
    return {scale * shift.x, scale * shift.y};
}

inline ReferenceImage perturb_reference(const void* parameters, const ReferenceInput& input) {
    const Perturb& p = *static_cast<const Perturb*>(parameters);
    const PerturbFrame frame = perturb_frame(p, input.time);
    ReferenceImage distortion;
    if (const auto* const image = find_resource<ResourceImage>(input.resources, p.distortion)) {
        distortion = ReferenceImage(image->width, image->height);
        for (std::size_t i = 0; i < distortion.pixels.size(); ++i)
            distortion.pixels[i] = {image->rgba[4 * i], image->rgba[4 * i + 1], 0, 1};
    }
    ReferenceImage out = *input.picture;
    const double width = out.width, height = out.height;
    const auto exact = [&](double u, double v) {
        const PerturbShift shift =
            perturb_shift(p, frame, u, v, width, height, distortion.width == 0 ? nullptr : &distortion);
        return std::array{shift.x, shift.y};
    };
    const bool is_grid = p.evaluation == PerturbEvaluation::Vertex || p.evaluation == PerturbEvaluation::Cpu;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const std::array shift = is_grid ? warp_grid_reference(p.grid, u, v, exact) : exact(u, v);
            out.at(x, y) = finite_sample_reference(*input.picture, u + shift[0] / width, v + shift[1] / height);
        }
    }
    return out;
}

}  // namespace darkroom
