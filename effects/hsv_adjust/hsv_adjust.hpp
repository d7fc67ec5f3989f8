// SPDX-License-Identifier: MIT
#pragma once
// HSV adjustment: turns the hue, scales saturation and value in the hexcone model. It keeps neither luminance nor
// evenness of hues: for that, see what grades in linear light.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct HsvAdjust {
    /// Angle by which hues turn: 120 makes red green. [-180, 180] deg
    float hue = 0.0f;
    /// Factor of the saturation, which stays at most 1. [0, 8]
    float saturation = 1.0f;
    /// Factor of the value, the largest of the channels. [0, 8]
    float value = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const HsvAdjust&);

}  // namespace darkroom
