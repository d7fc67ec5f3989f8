// SPDX-License-Identifier: MIT
#pragma once
// Negative in double precision: c' = mix(c, 1 - c, amount).

#include <darkroom/effects/negative.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba negative_reference(Rgba color, const ReferencePixel&, const Negative& parameters) {
    const double amount = parameters.amount;
    const auto invert = [amount](double v) { return v * (1.0 - amount) + (1.0 - v) * amount; };
    return {invert(color.r), invert(color.g), invert(color.b), color.a};
}

}  // namespace darkroom
