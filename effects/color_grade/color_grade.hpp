// SPDX-License-Identifier: MIT
#pragma once
// Colour grade: white balance, channel mixer, three ranges of tone, lift, gamma and gain, contrast and curves in stops,
// hue, vibrance and saturation, of the scene's light. It is no tone curve: light above 1 stays above 1.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ColorGrade {
    /// Colour temperature of the light that becomes white: above 6504 the picture gets warmer, below it colder. [2500,
    /// 25000] K
    float temperature = 6504.0f;
    /// Green of the light that becomes white, in 3000ths of CIE 1960 uv: above 0 the picture turns magenta. [-100, 100]
    float tint = 0.0f;
    /// Shares of red, green and blue in the new red. [-2, 2]
    Vec3 mixer_red{1, 0, 0};
    /// Shares of red, green and blue in the new green. [-2, 2]
    Vec3 mixer_green{0, 1, 0};
    /// Shares of red, green and blue in the new blue. [-2, 2]
    Vec3 mixer_blue{0, 0, 1};
    /// Factor of the dark range. [0, 4]
    Rgb shadows{1, 1, 1};
    /// Factor of the range between dark and bright. [0, 4]
    Rgb midtones{1, 1, 1};
    /// Factor of the bright range. [0, 4]
    Rgb highlights{1, 1, 1};
    /// Luminance at which the shadows begin to fade, then the width of the fade. [0, 64]
    Vec2 shadows_range{0.0f, 0.3f};
    /// Luminance at which the highlights begin, then the width of the fade. [0, 64]
    Vec2 highlights_range{0.55f, 0.45f};
    /// Light that is added (offset). [-1, 1]
    Rgb lift{0, 0, 0};
    /// Exponent 1 / gamma: above 1 the middle gets brighter. [0.1, 10]
    Rgb gamma{1, 1, 1};
    /// Factor of the light (slope). [0, 16]
    Rgb gain{1, 1, 1};
    /// Factor of the distance from the pivot, in stops. [0, 4]
    float contrast = 1.0f;
    /// Light that the contrast leaves as it is; 0.18 is middle grey. [0.001, 16]
    float pivot = 0.18f;
    /// Red out (y) for red in (x), both in stops from middle grey; an empty curve changes nothing. up to 16 points [x,
    /// y], x ascending, y in [-16, 16]
    Curve curve_red;
    /// Green out (y) for green in (x), both in stops from middle grey; an empty curve changes nothing. up to 16 points
    /// [x, y], x ascending, y in [-16, 16]
    Curve curve_green;
    /// Blue out (y) for blue in (x), both in stops from middle grey; an empty curve changes nothing. up to 16 points
    /// [x, y], x ascending, y in [-16, 16]
    Curve curve_blue;
    /// Angle by which hues turn; luminance stays. [-180, 180] deg
    float hue = 0.0f;
    /// Saturation added to pale colours; colourful ones get less of it. [-1, 1]
    float vibrance = 0.0f;
    /// Factor of the distance from grey; luminance stays. [0, 4]
    float saturation = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ColorGrade&);

}  // namespace darkroom
