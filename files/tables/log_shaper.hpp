// SPDX-License-Identifier: MIT
#pragma once
// Scene-linear light to [0, 1] and back by its logarithm, so that the steps of a table are steps of the eye: stops
// above and below a middle grey of 0.18. Header only, as evaluate.hpp.

#include <algorithm>
#include <cmath>

namespace darkroom {

struct LogShaper {
    static constexpr double grey = 0.18, lowest_stop = -10, highest_stop = 6.5;

    /// Light of the lowest stop and below, and NaN, is 0; beyond the highest one it goes on above 1.
    [[nodiscard]] static double encode(double light) {
        const double stops = std::log2(std::max(light, grey * std::exp2(lowest_stop)) / grey);
        return light > 0 ? (stops - lowest_stop) / (highest_stop - lowest_stop) : 0.0;
    }
    /// 0 and below is no light at all, so that black stays black.
    [[nodiscard]] static double decode(double value) {
        return value > 0 ? grey * std::exp2(lowest_stop + value * (highest_stop - lowest_stop)) : 0.0;
    }
};

}  // namespace darkroom
