// SPDX-License-Identifier: MIT
#pragma once
// RCAS with a strength of 2^stops; the range ends at the brightest of the five where that is above 1.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/sharpen.hpp>

#include "shared/finite_reference.hpp"
#include "shared/rcas_reference.hpp"

namespace darkroom {

inline ReferenceImage sharpen_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const double strength = std::exp2(double{static_cast<const Sharpen*>(parameters)->stops});
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const auto finite = [&](int dx, int dy) {
                const Rgba& color = picture.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy);
                return Rgba{finite_reference(color.r), finite_reference(color.g), finite_reference(color.b), color.a};
            };
            const RcasPixels five{finite(0, 0), finite(0, -1), finite(0, 1), finite(-1, 0), finite(1, 0)};
            double most = 1;
            for (const Rgba& p : {five.own, five.n, five.s, five.w, five.e}) most = std::max({most, p.r, p.g, p.b});
            out.at(x, y) = rcas_reference(five, 2 * most - 1, strength);
        }
    }
    return out;
}

}  // namespace darkroom
