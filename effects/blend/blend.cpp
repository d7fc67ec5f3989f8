// SPDX-License-Identifier: MIT
#include <darkroom/effects/blend.hpp>

#include "blend/blend_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Blend&) {
    static const EffectInfo info{
        .name = "blend",
        .doc = "Puts a second picture over the picture.",
        .parameters = blend_rows.table(),
        .files = embedded_files("blend"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .has_second = true,
        .has_second_in_place = true,
        .reference = blend_image_reference,
        .is_identity = [](const void* parameters) { return static_cast<const Blend*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
