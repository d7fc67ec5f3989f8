// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/hsv_adjust.hpp>

#include "hsv_adjust/hsv_adjust_reference.hpp"

namespace darkroom {

namespace {

constexpr auto hsv_adjust_rows =
    describe(field<&HsvAdjust::hue>("Angle by which hues turn: 120 makes red green.", {-180, 180}, unit::degrees),
             field<&HsvAdjust::saturation>("Factor of the saturation, which stays at most 1.", {0, 8}),
             field<&HsvAdjust::value>("Factor of the value, the largest of the channels.", {0, 8}));

}  // namespace

const EffectInfo& effect_info(const HsvAdjust&) {
    static const EffectInfo info{
        .name = "hsv_adjust",
        .doc = "Turns hues, and scales saturation and value.",
        .parameters = hsv_adjust_rows.table(),
        .files = embedded_files("hsv_adjust"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 73, .scene_linear = 81},
        .works = {.in = WorkingSpace::Straight},
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
