// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/ui_echo.hpp>

#include "ui_echo/ui_echo_reference.hpp"

namespace darkroom {

namespace {

constexpr auto ui_echo_rows =
    describe(field<&UiEcho::strength>("Brightness of the ghost.", {0, 4}).as_amount().also_named("r_ui_echo"),
             field<&UiEcho::size>("Side lengths of the ghost, relative to the interface's.", {0.05, 20, Scale::Log})
                 .also_named("r_ui_echo_scale"));

}  // namespace

const EffectInfo& effect_info(const UiEcho&) {
    static const EffectInfo info{
        .name = "ui_echo",
        .doc = "Adds a ghost of the interface, larger or smaller than it.",
        .parameters = ui_echo_rows.table(),
        .files = embedded_files("ui_echo"),
        .touch = Touch::Tap,
        .flat = {.documented = 114, .scene_linear = 114, .ui = UiPart::Layer},
        .reference = tap_reference<ui_echo_reference>(),
        .is_identity =
            [](const void* parameters) { return !(static_cast<const UiEcho*>(parameters)->strength > 0.0f); },
    };
    return info;
}

}  // namespace darkroom
