// SPDX-License-Identifier: MIT
#pragma once
// RCAS in double precision (AMD, "FidelityFX Super Resolution 1.0", 2021): c' = (c + l (n + s + w + e)) / (1 + 4 l),
// with l from the published limits, times 2^stops. Two things are ours: the range ends at the brightest of the five
// where that is above 1, and c' stays within what the five span.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/sharpen.hpp>
#include <darkroom/reference.hpp>
#include <limits>

#include "shared/finite_reference.hpp"

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
            const Rgba n = finite(0, -1), s = finite(0, 1), w = finite(-1, 0), e = finite(1, 0), own = finite(0, 0);
            constexpr double Rgba::*channels[] = {&Rgba::r, &Rgba::g, &Rgba::b};
            double most = 1, lobe = -std::numeric_limits<double>::infinity();
            for (const auto c : channels) most = std::max({most, n.*c, s.*c, w.*c, e.*c, own.*c});
            const double peak = 2 * most - 1;
            for (const auto c : channels) {
                const double low = std::min({n.*c, s.*c, w.*c, e.*c}), high = std::max({n.*c, s.*c, w.*c, e.*c});
                const double hit_min = high > 0 ? std::max(std::min(low, own.*c), 0.0) / (4 * high) : 0;
                const double hit_max = low < peak ? (peak - std::max(high, own.*c)) / (4 * low - 4 * peak) : 0;
                lobe = std::max({lobe, -hit_min, hit_max});
            }
            lobe = std::max(-(0.25 - 1.0 / 16), std::min(lobe, 0.0)) * strength;
            for (const auto c : channels) {
                const double around = n.*c + s.*c + w.*c + e.*c;
                out.at(x, y).*c =
                    std::clamp((lobe * around + own.*c) / (4 * lobe + 1), std::min({n.*c, s.*c, w.*c, e.*c, own.*c}),
                               std::max({n.*c, s.*c, w.*c, e.*c, own.*c}));
            }
        }
    }
    return out;
}

}  // namespace darkroom
