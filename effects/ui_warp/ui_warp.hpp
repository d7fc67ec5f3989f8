// SPDX-License-Identifier: MIT
#pragma once
// UI warp: bends the interface as if it were drawn on the inside of a visor, and moves it: it lags behind the head
// (darkroom/hud_inertia.hpp).

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiWarp {
    /// Barrel distortion: below 0 the corners bend outward, above 0 inward. [-4, 4]
    float strength = 0.0f;
    /// Shift in uv of the place where the layer is read; the interface moves the other way. [-1, 1]
    Vec2 offset;
};

[[nodiscard]] const EffectInfo& effect_info(const UiWarp&);

}  // namespace darkroom
