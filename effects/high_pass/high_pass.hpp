// SPDX-License-Identifier: MIT
#pragma once
// High pass: keeps what is bright and turns the rest black. It is the first step of a plain bloom, with a blur and an
// additive blend behind it; the effect `bloom` brings its own, softer threshold.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct HighPass {
    float threshold = 1.0f;
    float knee = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const HighPass&);

}  // namespace darkroom
