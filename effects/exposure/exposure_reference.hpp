// SPDX-License-Identifier: MIT
#pragma once
// Exposure in double precision: c' = c * exposure.

#include <darkroom/effects/exposure.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba exposure_reference(Rgba color, const ReferencePixel&, const Exposure& parameters) {
    const double scale = parameters.exposure;
    return {color.r * scale, color.g * scale, color.b * scale, color.a};
}

}  // namespace darkroom
