// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/ui_composite.hpp>

#include "ui_composite/ui_composite_reference.hpp"

namespace darkroom {

namespace {

constexpr auto ui_composite_rows = describe(
    field<&UiComposite::ui_opacity>("Opacity of the interface; it never fades below 0.1.", {0, 1})
        .also_named("scr_sbaralpha", true),
    field<&UiComposite::additive>(
        "Mix between laying the interface over the picture (0) and adding it as light (1), which is dimmed to 0.7.",
        {0, 1})
        .also_named("r_ui_additive"),
    field<&UiComposite::ui_white_nits>(
        "Luminance of the interface's white, where the picture is light or for an HDR display.", {1, 10000, Scale::Log},
        unit::nits));

float white_nits(const void* parameters) { return static_cast<const UiComposite*>(parameters)->ui_white_nits; }

}  // namespace

const EffectInfo& effect_info(const UiComposite&) {
    static const EffectInfo info{
        .name = "ui_composite",
        .doc = "Lays the interface over the finished picture.",
        .parameters = ui_composite_rows.table(),
        .files = embedded_files("ui_composite"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::Encoded),
        .needs = {FrameImage::Ui},
        .flat = {.documented = 120, .scene_linear = 120, .ui = UiPart::Picture},
        .second = Second::InPlace,
        .works = {.in = WorkingSpace::Encoded, .white_nits = white_nits},
        .reference = ui_composite_reference,
    };
    return info;
}

}  // namespace darkroom
