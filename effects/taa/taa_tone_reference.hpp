// SPDX-License-Identifier: MIT
#pragma once
// taa.glsl in double precision, and the filter by which the past is read.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/reference.hpp>
#include <numbers>
#include <numeric>

namespace darkroom::taa {

using Toned = std::array<double, 3>;

/// YCoCg.
inline Toned opponent(const Rgba& c) {
    return {c.r / 4 + c.g / 2 + c.b / 4, c.r / 2 - c.b / 2, -c.r / 4 + c.g / 2 - c.b / 4};
}

inline Toned toned(const Rgba& c, double unit) {
    const double scale = 1 / (unit + std::max({c.r, c.g, c.b}));
    return opponent({c.r * scale, c.g * scale, c.b * scale, 1});
}

inline Rgba shown(const Toned& t) {
    return {std::max(t[0] - t[2] + t[1], 0.0), std::max(t[0] + t[2], 0.0), std::max(t[0] - t[2] - t[1], 0.0), 1};
}

inline Rgba light(const Rgba& shown, double unit, double alpha) {
    const double scale = unit / std::max(1 - std::max({shown.r, shown.g, shown.b}), 1e-7);
    return {std::min(shown.r * scale, 65504.0), std::min(shown.g * scale, 65504.0), std::min(shown.b * scale, 65504.0),
            alpha};
}

/// Of the light that is shown as half of white, in 32nds.
inline double stops_of(double exposure) {
    return std::floor(0.5 - 32 * std::log2(std::clamp(exposure, 1e-6, 1e6))) / 32;
}

inline Toned sum(const Toned& a, const Toned& b, double scale) {
    return {a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale};
}

/// Along an axis, at `f` of the way to the next pixel: a Lanczos filter of three lobes with a sum of 1, whose two
/// texels in the middle are one filtered tap.
struct Taps {
    explicit Taps(double f) {
        const auto weight = [](double x) {
            const double p = std::numbers::pi * x;
            return std::abs(x) < 1e-9 ? 1 : std::abs(x) < 3 ? 3 * std::sin(p) * std::sin(p / 3) / (p * p) : 0;
        };
        const double second = weight(f), third = weight(1 - f);
        weights = {weight(f + 2), weight(f + 1), second + third, weight(2 - f), weight(3 - f)};
        const double all = std::reduce(weights.begin(), weights.end());
        for (double& w : weights) w /= all;
        places[2] = third / (second + third);
    }
    std::array<double, 5> weights{}, places{-2, -1, 0, 2, 3};
};

}  // namespace darkroom::taa
