// SPDX-License-Identifier: MIT
#pragma once
// Radial blur in double precision: the mean of eight bilinear taps at +-0.5, 1.5, 2.5 and 3.5 steps of 0.04 s d along
// the line through the centre, d the distance from it in uv; mixed in by clamp(smoothstep(0.1, 0.7, d) s, 0, 1).

#include <algorithm>
#include <cmath>
#include <darkroom/effects/radial_blur.hpp>
#include <darkroom/reference.hpp>

#include "shared/sample_reference.hpp"

namespace darkroom {

inline ReferenceImage radial_blur_reference(const void* parameters, const ReferenceInput& input) {
    const RadialBlur& blur = *static_cast<const RadialBlur*>(parameters);
    const double strength = double{blur.radial_blur};
    ReferenceImage out = *input.picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / out.width, v = (y + 0.5) / out.height;
            const double du = u - double{blur.center.x}, dv = v - double{blur.center.y};
            const double distance = std::hypot(du, dv);
            Rgba mean{0, 0, 0, 0};
            for (int i = 0; i < 8; ++i) {
                const double t = (i - 3.5) * strength * 0.04;
                const Rgba tap = finite_sample_reference(*input.picture, u + du * t, v + dv * t);
                mean = {mean.r + tap.r / 8, mean.g + tap.g / 8, mean.b + tap.b / 8, 0};
            }
            const double s = std::clamp((distance - 0.1) / 0.6, 0.0, 1.0);
            const double amount = std::clamp(s * s * (3 - 2 * s) * strength, 0.0, 1.0);
            Rgba& pixel = out.at(x, y);
            pixel = {finite_reference(pixel.r), finite_reference(pixel.g), finite_reference(pixel.b),
                     finite_reference(pixel.a)};
            pixel = {std::lerp(pixel.r, mean.r, amount), std::lerp(pixel.g, mean.g, amount),
                     std::lerp(pixel.b, mean.b, amount), pixel.a};
        }
    }
    return out;
}

}  // namespace darkroom
