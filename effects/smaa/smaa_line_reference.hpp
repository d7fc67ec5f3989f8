// SPDX-License-Identifier: MIT
#pragma once
// Areas between an edge of pixels and the line that it stands for, in closed form: what smaa.glsl computes.

#include <algorithm>

namespace darkroom {

struct SmaaAreas {
    double own = 0, other = 0;
};

/// A line over a pixel's edge: its heights at both sides, toward the neighbour across.
struct SmaaLine {
    double a = 0, b = 0;
    [[nodiscard]] SmaaAreas areas() const {
        const auto above = [](double from, double to) {
            const double p = std::max(from, 0.0), q = std::max(to, 0.0);
            return p * p - q * q;
        };
        const double change = a - b;
        if (change == 0) return {};
        return {above(-a, -b) / (-2 * change), above(a, b) / (2 * change)};
    }
};

/// Of a pixel `before` others on a step of `length` pixels, whose line rises toward the neighbour across: as steep as
/// it and the steps before and behind are together, through the mean of their middles.
inline SmaaLine smaa_straight(double before, double length, double previous, double next) {
    const double mean = (previous + length + next) / 3, middle = length / 2 + (next - previous) / 6;
    return {(before - middle) / mean, (before + 1 - middle) / mean};
}

/// The same where both ends bend to heights, or not at all: from each end to the edge's middle, where the line meets
/// the edge, by the integral of 1 - 2 t as far as that is.
inline SmaaAreas smaa_bent(double from_height, double to_height, double before, double length) {
    const double from = before / length, to = from + 1 / length;
    const auto half = [&](double a, double b) {
        const double p = std::max(1 - 2 * a, 0.0), q = std::max(1 - 2 * b, 0.0);
        return (p * p - q * q) * length / 4;
    };
    const double area = from_height * half(from, to) + to_height * half(1 - to, 1 - from);
    return {std::max(-area, 0.0), std::max(area, 0.0)};
}

}  // namespace darkroom
