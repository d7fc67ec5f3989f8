// SPDX-License-Identifier: MIT
#pragma once
// Colour grade: white balance, channel mixer, three ranges of tone, lift, gamma and gain, contrast and curves in stops,
// hue, vibrance and saturation, of the scene's light. It is no tone curve: light above 1 stays above 1.

#include <darkroom/effect.hpp>

namespace darkroom {

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
inline constexpr auto color_grade_rows = describe(
    field<&ColorGrade::temperature>("Colour temperature of the light that becomes white: above 6504 the picture gets "
                                    "warmer, below it colder.",
                                    {2500, 25000, Scale::Log}, Unit{"K"}),
    field<&ColorGrade::tint>("How green that light is, in 3000ths of CIE 1960 uv: above 0 the picture turns magenta.",
                             {-100, 100}),
    field<&ColorGrade::mixer_red>("How much of red, green and blue the new red holds.", {-2, 2}),
    field<&ColorGrade::mixer_green>("How much of red, green and blue the new green holds.", {-2, 2}),
    field<&ColorGrade::mixer_blue>("How much of red, green and blue the new blue holds.", {-2, 2}),
    field<&ColorGrade::shadows>("Factor of what is dark.", {0, 4}),
    field<&ColorGrade::midtones>("Factor of what lies between dark and bright.", {0, 4}),
    field<&ColorGrade::highlights>("Factor of what is bright.", {0, 4}),
    field<&ColorGrade::shadows_range>("Luminance at which the shadows begin to fade, and the width over which they do.",
                                      {0, 64}),
    field<&ColorGrade::highlights_range>("Luminance at which the highlights begin, and the width over which they do.",
                                         {0, 64}),
    field<&ColorGrade::lift>("Light that is added: offset.", {-1, 1}),
    field<&ColorGrade::gamma>("Exponent 1 / gamma: above 1 the middle gets brighter.", {0.1, 10, Scale::Log}),
    field<&ColorGrade::gain>("Factor of the light: slope.", {0, 16}),
    field<&ColorGrade::contrast>("Factor of the distance from the pivot, in stops.", {0, 4}),
    field<&ColorGrade::pivot>("Light that the contrast leaves as it is; 0.18 is middle grey.", {0.001, 16, Scale::Log}),
    field<&ColorGrade::curve_red>("Red out for red in, both in stops from middle grey; none: as it is.", {-16, 16}),
    field<&ColorGrade::curve_green>("Green out for green in, both in stops from middle grey.", {-16, 16}),
    field<&ColorGrade::curve_blue>("Blue out for blue in, both in stops from middle grey.", {-16, 16}),
    field<&ColorGrade::hue>("Angle by which hues turn; luminance stays.", {-180, 180}, unit::degrees),
    field<&ColorGrade::vibrance>("Saturation for pale colours, and less the more colour there is.", {-1, 1}),
    field<&ColorGrade::saturation>("Factor of the distance from grey; luminance stays.", {0, 4}));

[[nodiscard]] const EffectInfo& effect_info(const ColorGrade&);

}  // namespace darkroom
