// SPDX-License-Identifier: MIT
#pragma once
// Colour grade: white balance, channel mixer, three ranges of tone, lift, gamma and gain, contrast and curves in stops,
// hue, vibrance and saturation, of the scene's light. It is no tone curve: light above 1 stays above 1.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ColorGrade {
    float temperature = 6504.0f;
    float tint = 0.0f;
    Vec3 mixer_red{1, 0, 0}, mixer_green{0, 1, 0}, mixer_blue{0, 0, 1};
    Rgb shadows{1, 1, 1}, midtones{1, 1, 1}, highlights{1, 1, 1};
    Vec2 shadows_range{0.0f, 0.3f}, highlights_range{0.55f, 0.45f};
    Rgb lift{0, 0, 0}, gamma{1, 1, 1}, gain{1, 1, 1};
    float contrast = 1.0f;
    float pivot = 0.18f;
    Curve curve_red, curve_green, curve_blue;
    float hue = 0.0f;
    float vibrance = 0.0f;
    float saturation = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ColorGrade&);

}  // namespace darkroom
