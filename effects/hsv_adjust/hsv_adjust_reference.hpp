// SPDX-License-Identifier: MIT
#pragma once
// HSV adjustment in double precision, by the two procedures of Alvy Ray Smith, "Color Gamut Transform Pairs", 1978: to
// the hexcone and back. Hue is in sixths of a turn. Negative light and NaN count as 0, infinity as 65504.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/hsv_adjust.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"

namespace darkroom {

struct Hsv {
    double hue = 0, saturation = 0, value = 0;
};

inline Hsv hsv_of(double r, double g, double b) {
    const double value = std::max({r, g, b}), least = std::min({r, g, b}), chroma = value - least;
    if (chroma <= 0) return {0, 0, value};
    // Distances from the largest channel, as parts of the chroma.
    const double dr = (value - r) / chroma, dg = (value - g) / chroma, db = (value - b) / chroma;
    double hue = 0;
    if (r == value)
        hue = b == least ? 1 - dg : 5 + db;
    else if (g == value)
        hue = b == least ? 1 + dr : 3 - db;
    else
        hue = r == least ? 3 + dg : 5 - dr;
    return {hue, chroma / value, value};
}

inline Rgba rgb_of(const Hsv& hsv, double alpha) {
    const double turns = std::floor(hsv.hue / 6), hue = hsv.hue - 6 * turns;
    const int sector = std::min(static_cast<int>(hue), 5);
    const double f = hue - sector, v = hsv.value;
    const double m = v * (1 - hsv.saturation), n = v * (1 - hsv.saturation * f), k = v * (1 - hsv.saturation * (1 - f));
    switch (sector) {
        case 0:
            return {v, k, m, alpha};
        case 1:
            return {n, v, m, alpha};
        case 2:
            return {m, v, k, alpha};
        case 3:
            return {m, n, v, alpha};
        case 4:
            return {k, m, v, alpha};
        default:
            return {v, m, n, alpha};
    }
}

inline Rgba hsv_adjust_reference(Rgba color, const ReferencePixel&, const HsvAdjust& parameters) {
    Hsv hsv = hsv_of(finite_light_reference(color.r), finite_light_reference(color.g), finite_light_reference(color.b));
    hsv.hue += double{parameters.hue} / 60;
    hsv.saturation = std::min(hsv.saturation * double{parameters.saturation}, 1.0);
    hsv.value *= double{parameters.value};
    return rgb_of(hsv, color.a);
}

}  // namespace darkroom
