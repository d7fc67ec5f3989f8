// SPDX-License-Identifier: MIT
#pragma once
// Vignette in double precision: c' = c * max(0, 1 - d^smoothness * intensity), d the distance from the centre in uv, 1
// at the corner.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/vignette.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba vignette_reference(Rgba color, const ReferencePixel& pixel, const Vignette& parameters) {
    const double distance = std::hypot(pixel.u - 0.5, pixel.v - 0.5) * std::sqrt(2.0);
    const double factor =
        std::max(0.0, 1.0 - std::pow(distance, double{parameters.smoothness}) * double{parameters.intensity});
    return {color.r * factor, color.g * factor, color.b * factor, color.a};
}

}  // namespace darkroom
