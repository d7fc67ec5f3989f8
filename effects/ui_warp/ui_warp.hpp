// SPDX-License-Identifier: MIT
#pragma once
// UI warp: bends the interface as if it were drawn on the inside of a visor, and moves it: it lags behind the head
// (darkroom/hud_inertia.hpp).

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiWarp {
    float strength = 0.0f;
    Vec2 offset;
};

[[nodiscard]] const EffectInfo& effect_info(const UiWarp&);

}  // namespace darkroom
