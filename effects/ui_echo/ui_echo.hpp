// SPDX-License-Identifier: MIT
#pragma once
// UI echo: a ghost of the interface around it, as a reflection in the visor's glass. It is bent as the interface is.

#include <darkroom/effect.hpp>

namespace darkroom {

struct UiEcho {
    float strength = 0.0f;
    float size = 1.0f;
};
inline constexpr auto ui_echo_rows =
    describe(field<&UiEcho::strength>("How bright the ghost is.", {0, 4}).as_amount().also_named("r_ui_echo"),
             field<&UiEcho::size>("Sides of the ghost, relative to the interface's.", {0.05, 20, Scale::Log})
                 .also_named("r_ui_echo_scale"));

[[nodiscard]] const EffectInfo& effect_info(const UiEcho&);

}  // namespace darkroom
