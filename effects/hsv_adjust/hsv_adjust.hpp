// SPDX-License-Identifier: MIT
#pragma once
// HSV adjustment: turns the hue, scales saturation and value in the hexcone model. It keeps neither luminance nor
// evenness of hues: for that, see what grades in linear light.

#include <darkroom/effect.hpp>

namespace darkroom {

struct HsvAdjust {
    float hue = 0.0f;
    float saturation = 1.0f;
    float value = 1.0f;
};
inline constexpr auto hsv_adjust_rows =
    describe(field<&HsvAdjust::hue>("Angle by which hues turn: 120 makes red green.", {-180, 180}, unit::degrees),
             field<&HsvAdjust::saturation>("Factor of the saturation, which stays at most 1.", {0, 8}),
             field<&HsvAdjust::value>("Factor of the value, the largest of the channels.", {0, 8}));

[[nodiscard]] const EffectInfo& effect_info(const HsvAdjust&);

}  // namespace darkroom
