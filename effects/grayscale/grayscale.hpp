// SPDX-License-Identifier: MIT
#pragma once
// Grayscale: takes the colour out and keeps the luminance. It is not a channel mixer for black-and-white looks.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Grayscale {
    /// Share of the colour that is removed; 0 leaves the picture as it is. [0, 1]
    float amount = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Grayscale&);

}  // namespace darkroom
