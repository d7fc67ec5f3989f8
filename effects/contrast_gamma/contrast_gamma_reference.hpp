// SPDX-License-Identifier: MIT
#pragma once
// Contrast and gamma in double precision: c' = max(0, c contrast)^gamma.

#include <cmath>
#include <darkroom/effects/contrast_gamma.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba contrast_gamma_reference(Rgba color, const ReferencePixel&, const ContrastGamma& parameters) {
    const auto one = [&](double value) {
        const double scaled = value * double{parameters.contrast};
        return scaled > 0 ? std::pow(scaled, double{parameters.gamma}) : 0.0;
    };
    return {one(color.r), one(color.g), one(color.b), color.a};
}

}  // namespace darkroom
