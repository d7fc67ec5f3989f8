// SPDX-License-Identifier: MIT
#pragma once
// UI composite: the interface over the picture, both encoded; premultiplied, or as light that is added.

#include <darkroom/effect.hpp>

namespace darkroom {

struct UiComposite {
    float ui_opacity = 1.0f;
    float additive = 0.0f;
};
inline constexpr auto ui_composite_rows =
    describe(field<&UiComposite::ui_opacity>("Of the interface; it never fades below 0.1.", {0, 1})
                 .also_named("scr_sbaralpha", true),
             field<&UiComposite::additive>("From laid over (0) to added as light (1), which is dimmed to 0.7.", {0, 1})
                 .also_named("r_ui_additive"));

[[nodiscard]] const EffectInfo& effect_info(const UiComposite&);

}  // namespace darkroom
