// SPDX-License-Identifier: MIT
#pragma once
// High pass: keeps what is bright and turns the rest black. It is the first step of a plain bloom, with a blur and an
// additive blend behind it; the effect `bloom` brings its own, softer threshold.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct HighPass {
    /// Colours of at least this luminance stay; 0 keeps all light. [0, 65504]
    float threshold = 1.0f;
    /// Width below the threshold over which colours fade in; 0 is a hard edge. [0, 65504]
    float knee = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const HighPass&);

}  // namespace darkroom
