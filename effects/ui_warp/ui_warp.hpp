// SPDX-License-Identifier: MIT
#pragma once
// UI warp: bends the interface as if it were drawn on the inside of a visor, and moves it: it lags behind the head
// (darkroom/hud_inertia.hpp).

#include <darkroom/effect.hpp>

namespace darkroom {

struct UiWarp {
    float strength = 0.0f;
    Vec2 offset;
};
inline constexpr auto ui_warp_rows =
    describe(field<&UiWarp::strength>("Barrel distortion: below 0 the corners bend outward, above 0 inward.", {-4, 4})
                 .as_amount()
                 .also_named("r_ui_warp"),
             field<&UiWarp::offset>("Where the layer is read, moved in uv: the interface goes the other way.", {-1, 1})
                 .also_named("r_ui_offset"));

[[nodiscard]] const EffectInfo& effect_info(const UiWarp&);

}  // namespace darkroom
