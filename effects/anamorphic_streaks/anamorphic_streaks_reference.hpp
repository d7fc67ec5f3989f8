// SPDX-License-Identifier: MIT
#pragma once
// Anamorphic streaks in double precision: c' = c + intensity tint S(L), where S is along a line the sum over texels k,
// |k| < 256, of a^|k|, a = exp(-1 / length), divided by the sum of these. The kernels make it of steps to either side
// (Masaki Kawase, "Frame buffer postprocessing effects in DOUBLE-S.T.E.A.L", 2003): 1 + z + z^2 + z^3, z = a^(4^i),
// whose product is the sum of all powers of a below 256.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/anamorphic_streaks.hpp>
#include <darkroom/reference.hpp>
#include <vector>

#include "shared/small_light.hpp"

namespace darkroom {

inline constexpr std::uint32_t anamorphic_streaks_steps = 4;
inline constexpr std::int64_t anamorphic_streaks_reach = 256;  ///< 4^4

/// What a texel of the small picture leaves to the next.
inline double anamorphic_streaks_decay(const AnamorphicStreaks& streaks, std::uint32_t width, std::uint32_t height,
                                       std::uint32_t small_width) {
    return std::exp(-static_cast<double>(width) / small_width / (double{streaks.length} * height / 1080));
}

/// The weights of a step's texels to one side, which sum to 1.
inline std::array<double, 4> anamorphic_streaks_weights(double decay, std::uint32_t step) {
    const double z = std::pow(decay, std::pow(4, step)), sum = 1 + z + z * z + z * z * z;
    return {1 / sum, z / sum, z * z / sum, z * z * z / sum};
}
/// The sum of all weights to one side, were that of the light itself 1.
inline double anamorphic_streaks_side(double decay) {
    return (1 - std::pow(decay, anamorphic_streaks_reach)) / (1 - decay);
}

inline ReferenceImage anamorphic_streaks_line_reference(const ReferenceImage& light, double decay) {
    constexpr std::int64_t reach = anamorphic_streaks_reach;
    std::vector<double> weights;
    double sum = 0;
    for (std::int64_t i = 0; i < reach; ++i) {
        weights.push_back(std::pow(decay, i));
        sum += i == 0 ? weights.back() : 2 * weights.back();
    }
    ReferenceImage out(light.width, light.height, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (std::uint32_t from = 0; from < out.width; ++from) {
                const std::int64_t distance = std::abs(std::int64_t{x} - from);
                if (distance < reach)
                    out.at(x, y) = weighed_sum_reference(out.at(x, y), light.at(from, y),
                                                         weights[static_cast<std::size_t>(distance)] / sum);
            }
    return out;
}

inline ReferenceImage anamorphic_streaks_reference(const void* parameters, const ReferenceInput& input) {
    const AnamorphicStreaks& streaks = *static_cast<const AnamorphicStreaks*>(parameters);
    ReferenceImage out = *input.picture;
    const ReferenceImage light = bright_reference(*input.source, double{streaks.threshold});
    const ReferenceImage drawn =
        anamorphic_streaks_line_reference(light, anamorphic_streaks_decay(streaks, out.width, out.height, light.width));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba streak = sample_reference(drawn, (x + 0.5) / out.width, (y + 0.5) / out.height);
            Rgba& color = out.at(x, y);
            color.r += double{streaks.intensity} * double{streaks.tint.r} * streak.r;
            color.g += double{streaks.intensity} * double{streaks.tint.g} * streak.g;
            color.b += double{streaks.intensity} * double{streaks.tint.b} * streak.b;
        }
    return out;
}

}  // namespace darkroom
