// SPDX-License-Identifier: MIT
#pragma once
// High pass in double precision: c' = c where Y >= threshold, else 0; with a knee c' = c smoothstep(threshold - knee,
// threshold, Y). Y is the luminance of ITU-R BT.709.

#include <algorithm>
#include <darkroom/effects/high_pass.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba high_pass_reference(Rgba color, const ReferencePixel&, const HighPass& parameters) {
    const double luminance = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    const double threshold = parameters.threshold, knee = parameters.knee;
    if (luminance >= threshold) return color;
    if (knee <= 0 || !(luminance > threshold - knee)) return {0, 0, 0, color.a};
    const double t = (luminance - (threshold - knee)) / knee;
    const double kept = t * t * (3 - 2 * t);
    return {color.r * kept, color.g * kept, color.b * kept, color.a};
}

}  // namespace darkroom
