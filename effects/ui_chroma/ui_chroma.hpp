// SPDX-License-Identifier: MIT
#pragma once
// UI chroma: red and blue of the interface are bent a little more and less than green, as by a cheap visor. The bend
// adds to that of ui_warp.

#include <darkroom/effect.hpp>

namespace darkroom {

struct UiChroma {
    float strength = 0.0f;
};
inline constexpr auto ui_chroma_rows = describe(
    field<&UiChroma::strength>("How much the barrels of red and blue differ from green's, for 1080 lines: less on "
                               "taller pictures.",
                               {0, 1})
        .as_amount()
        .also_named("r_ui_chromatic"));

[[nodiscard]] const EffectInfo& effect_info(const UiChroma&);

}  // namespace darkroom
