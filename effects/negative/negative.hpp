// SPDX-License-Identifier: MIT
#pragma once
// Negative: one minus the colour. It is not the inversion of a film scan.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Negative {
    /// Share of the negative; 0 leaves the picture as it is. [0, 1]
    float amount = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Negative&);

}  // namespace darkroom
