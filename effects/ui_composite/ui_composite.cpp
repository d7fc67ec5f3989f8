// SPDX-License-Identifier: MIT
#include <darkroom/effects/ui_composite.hpp>

#include "ui_composite/ui_composite_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const UiComposite&) {
    static const EffectInfo info{
        .name = "ui_composite",
        .doc = "The interface over the finished picture.",
        .parameters = ui_composite_rows.table(),
        .files = embedded_files("ui_composite"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::Encoded),
        .needs = {.ui = true},
        .flat = {.documented = 120, .scene_linear = 98, .is_of_ui = true},
        .has_second = true,
        .has_second_in_place = true,
        .works_encoded = true,
        .reference = ui_composite_reference,
    };
    return info;
}

}  // namespace darkroom
