// SPDX-License-Identifier: MIT
#pragma once
// Lens distortion in double precision: the pixel at distance r from the centre shows what lies at
// r (1 + k1 r^2 + k2 r^4), the radial polynomial of Duane C. Brown, "Decentering Distortion of Lenses", 1966, which
// goes back to A. E. Conrady, 1919. r is 1 in a corner.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/lens_distortion.hpp>
#include <darkroom/reference.hpp>

#include "shared/sample_reference.hpp"
#include "shared/warp_grid_reference.hpp"

namespace darkroom {

/// How far outward the pixel at r reads, before anything is scaled: channel 0 is red.
inline double lens_distortion_reference_factor(const LensDistortion& lens, int channel, double r) {
    const double k = double{lens.lens_distortion} + (1 - channel) * double{lens.dispersion};
    return 1 + k * r * r + double{lens.quartic} * r * r * r * r;
}

/// The scale with which the border of the picture just reads inside: found by trying the border.
inline double lens_distortion_reference_scale(const LensDistortion& lens, double width, double height) {
    if (!lens.fill) return 1;
    const double diagonal = std::hypot(width, height);
    double largest = 0;
    for (const double side : {width, height})
        for (int i = 0; i <= 4096; ++i)
            for (const int channel : {0, 1, 2}) {
                const double r = std::hypot(width + height - side, side * i / 4096) / diagonal;
                largest = std::max(largest, lens_distortion_reference_factor(lens, channel, r));
            }
    return largest > 0 ? 1 / largest : 1;
}

inline ReferenceImage lens_distortion_reference(const void* parameters, const ReferenceInput& input) {
    const auto& lens = *static_cast<const LensDistortion*>(parameters);
    const ReferenceImage& picture = *input.picture;
    const double width = picture.width, height = picture.height, diagonal = std::hypot(width, height);
    const double scale = lens_distortion_reference_scale(lens, width, height);
    // Where each channel is read for the pixel at (u, v).
    const auto exact = [&](double u, double v) {
        const double r = 2 * std::hypot((u - 0.5) * width, (v - 0.5) * height) / diagonal;
        std::array<double, 6> places{};
        for (const std::size_t channel : {0u, 1u, 2u}) {
            const double factor = scale * lens_distortion_reference_factor(lens, static_cast<int>(channel), r);
            places[2 * channel] = 0.5 + (u - 0.5) * factor;
            places[2 * channel + 1] = 0.5 + (v - 0.5) * factor;
        }
        return places;
    };
    ReferenceImage out(picture.width, picture.height);
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const auto places = lens.evaluation == LensDistortionEvaluation::Vertex
                                    ? warp_grid_reference(lens.grid, u, v, exact)
                                    : exact(u, v);
            std::array<Rgba, 3> taps;
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double at_u = places[2 * channel], at_v = places[2 * channel + 1];
                // Black beyond the picture, by way of one pixel.
                const double inside = std::clamp((0.5 - std::abs(at_u - 0.5)) * width + 1, 0.0, 1.0) *
                                      std::clamp((0.5 - std::abs(at_v - 0.5)) * height + 1, 0.0, 1.0);
                const Rgba tap = finite_sample_reference(picture, at_u, at_v);
                taps[channel] = {tap.r * inside, tap.g * inside, tap.b * inside, tap.a * inside};
            }
            out.at(x, y) = {taps[0].r, taps[1].g, taps[2].b, taps[1].a};
        }
    }
    return out;
}

}  // namespace darkroom
