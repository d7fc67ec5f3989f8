// SPDX-License-Identifier: MIT
#pragma once
// Negative: one minus the colour. It is not the inversion of a film scan.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Negative {
    float amount = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Negative&);

}  // namespace darkroom
