// SPDX-License-Identifier: MIT
#pragma once
// UI chroma: red and blue of the interface are bent a little more and less than green, as by a cheap visor. The bend
// adds to that of ui_warp.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiChroma {
    /// Difference of the red and blue barrels from the green one, at 1080 lines; taller pictures get less. [0, 1]
    float strength = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const UiChroma&);

}  // namespace darkroom
