// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/ui_warp.hpp>

#include "ui_warp/ui_warp_reference.hpp"

namespace darkroom {

namespace {

constexpr auto ui_warp_rows =
    describe(field<&UiWarp::strength>("Barrel distortion: below 0 the corners bend outward, above 0 inward.", {-4, 4})
                 .as_amount()
                 .also_named("r_ui_warp"),
             field<&UiWarp::offset>(
                 "Shift in uv of the place where the layer is read; the interface moves the other way.", {-1, 1})
                 .also_named("r_ui_offset"));

}  // namespace

const EffectInfo& effect_info(const UiWarp&) {
    static const EffectInfo info{
        .name = "ui_warp",
        .doc = "Bends and moves the interface.",
        .parameters = ui_warp_rows.table(),
        .files = embedded_files("ui_warp"),
        .touch = Touch::Map,
        .flat = {.documented = 112, .scene_linear = 112, .ui = UiPart::Layer},
        .reference = map_reference<ui_warp_reference>(),
        .is_identity =
            [](const void* parameters) {
                const UiWarp& values = *static_cast<const UiWarp*>(parameters);
                return values.strength == 0.0f && values.offset.x == 0.0f && values.offset.y == 0.0f;
            },
    };
    return info;
}

}  // namespace darkroom
