// SPDX-License-Identifier: MIT
#pragma once
// Grayscale in double precision: c' = mix(c, Y, amount), Y the luminance of ITU-R BT.709.

#include <darkroom/effects/grayscale.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba grayscale_reference(Rgba color, const ReferencePixel&, const Grayscale& parameters) {
    const double luminance = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    const double amount = parameters.amount;
    const auto fade = [=](double v) { return v * (1.0 - amount) + luminance * amount; };
    return {fade(color.r), fade(color.g), fade(color.b), color.a};
}

}  // namespace darkroom
