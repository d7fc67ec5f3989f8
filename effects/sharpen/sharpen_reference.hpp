// SPDX-License-Identifier: MIT
#pragma once
// RCAS or CAS (Timothy Lottes, "FidelityFX Contrast Adaptive Sharpening", 2019) with a strength of 2^stops. Two things
// are ours: the range goes on where the brightest of the pixels is above 1, and the result stays within what the five
// span.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/sharpen.hpp>

#include "shared/finite_reference.hpp"
#include "shared/rcas_reference.hpp"

namespace darkroom {

/// Of the pixel, those above, below, left and right of it, and those at its corners, in this order.
inline Rgba cas_reference(const std::array<Rgba, 9>& p, double strength) {
    double brightest = 1;
    for (const Rgba& c : p) brightest = std::max({brightest, c.r, c.g, c.b});
    const double peak = 2 * brightest - 1;
    Rgba out = p[0];
    for (double Rgba::*const c : {&Rgba::r, &Rgba::g, &Rgba::b}) {
        const auto [low, high] = std::minmax({p[0].*c, p[1].*c, p[2].*c, p[3].*c, p[4].*c});
        const double lowest = std::min({low, p[5].*c, p[6].*c, p[7].*c, p[8].*c});
        const double highest = std::max({high, p[5].*c, p[6].*c, p[7].*c, p[8].*c});
        const double both_high = high + highest, least = std::min(low + lowest, 2 * peak - both_high);
        const double room = both_high > 0 ? std::clamp(least / both_high, 0.0, 1.0) : 0;
        const double lobe = -std::sqrt(room) * strength / 5;
        const double around = p[1].*c + p[2].*c + p[3].*c + p[4].*c;
        out.*c = std::clamp((lobe * around + p[0].*c) / (1 + 4 * lobe), low, high);
    }
    return out;
}

inline ReferenceImage sharpen_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const Sharpen& sharpen = *static_cast<const Sharpen*>(parameters);
    const double strength = std::exp2(double{sharpen.stops});
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const auto finite = [&](int dx, int dy) {
                const Rgba& color = picture.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy);
                return Rgba{finite_reference(color.r), finite_reference(color.g), finite_reference(color.b), color.a};
            };
            const RcasPixels five{finite(0, 0), finite(0, -1), finite(0, 1), finite(-1, 0), finite(1, 0)};
            if (sharpen.mode == SharpenMode::Cas) {
                out.at(x, y) = cas_reference({five.own, five.n, five.s, five.w, five.e, finite(-1, -1), finite(1, -1),
                                              finite(-1, 1), finite(1, 1)},
                                             strength);
                continue;
            }
            double most = 1;
            for (const Rgba& p : {five.own, five.n, five.s, five.w, five.e}) most = std::max({most, p.r, p.g, p.b});
            out.at(x, y) = rcas_reference(five, 2 * most - 1, strength);
        }
    }
    return out;
}

}  // namespace darkroom
