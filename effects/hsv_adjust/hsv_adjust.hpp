// SPDX-License-Identifier: MIT
#pragma once
// HSV adjustment: turns the hue, scales saturation and value in the hexcone model. It keeps neither luminance nor
// evenness of hues: for that, see what grades in linear light.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct HsvAdjust {
    float hue = 0.0f;
    float saturation = 1.0f;
    float value = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const HsvAdjust&);

}  // namespace darkroom
