// SPDX-License-Identifier: MIT
#include <darkroom/effects/hsv_adjust.hpp>

#include "hsv_adjust/hsv_adjust_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const HsvAdjust&) {
    static const EffectInfo info{
        .name = "hsv_adjust",
        .doc = "Turns hues, and scales saturation and value.",
        .parameters = hsv_adjust_rows.table(),
        .files = embedded_files("hsv_adjust"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .reference = pointwise_reference<HsvAdjust, hsv_adjust_reference>,
        .is_identity =
            [](const void* parameters) {
                const auto& hsv = *static_cast<const HsvAdjust*>(parameters);
                return hsv.hue == 0.0f && hsv.saturation == 1.0f && hsv.value == 1.0f;
            },
    };
    return info;
}

}  // namespace darkroom
