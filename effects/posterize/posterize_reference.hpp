// SPDX-License-Identifier: MIT
#pragma once
// Posterize in double precision: the uniform quantiser with a level at 0 (Allen Gersho, "Quantization", 1977),
// q(v) = floor(v n + 1/2) / n with n = levels - 1, of each channel, or of the luma of ITU-R BT.709, c' = c q(Y) / Y.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/posterize.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"

namespace darkroom {

inline Rgba posterize_reference(Rgba color, const ReferencePixel&, const Posterize& parameters) {
    const double r = finite_reference(color.r), g = finite_reference(color.g), b = finite_reference(color.b),
                 n = parameters.levels - 1;
    const auto level = [n](double v) { return std::floor(v * n + 0.5) / n; };
    if (parameters.mode == PosterizeMode::Channel) return {level(r), level(g), level(b), color.a};
    const double luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    if (luma <= 0) return {0, 0, 0, color.a};
    const double scale = level(luma) / luma;
    return {r * scale, g * scale, b * scale, color.a};
}

}  // namespace darkroom
