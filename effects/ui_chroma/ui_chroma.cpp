// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/ui_chroma.hpp>

#include "ui_chroma/ui_chroma_reference.hpp"

namespace darkroom {

namespace {

constexpr auto ui_chroma_rows = describe(
    field<&UiChroma::strength>(
        "Difference of the red and blue barrels from the green one, at 1080 lines; taller pictures get less.", {0, 1})
        .as_amount()
        .also_named("r_ui_chromatic"));

}  // namespace

const EffectInfo& effect_info(const UiChroma&) {
    static const EffectInfo info{
        .name = "ui_chroma",
        .doc = "Separates the colours of the interface toward its edges.",
        .parameters = ui_chroma_rows.table(),
        .files = embedded_files("ui_chroma"),
        .touch = Touch::Map,
        .flat = {.documented = 113, .scene_linear = 113, .ui = UiPart::Layer},
        .parts_channels = true,
        .reference = map_reference<ui_chroma_reference>(),
        .is_identity =
            [](const void* parameters) { return !(static_cast<const UiChroma*>(parameters)->strength > 0.0f); },
    };
    return info;
}

}  // namespace darkroom
