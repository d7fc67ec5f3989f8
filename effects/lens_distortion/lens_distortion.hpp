// SPDX-License-Identifier: MIT
#pragma once
// Lens distortion: bends the picture as a lens does, into a barrel or a pincushion, each colour by a little more or
// less. It bends what was made; it does not see more of the scene than the camera did.

#include <darkroom/effect.hpp>

namespace darkroom {

struct LensDistortion {
    float lens_distortion = 0.0f;
    float quartic = 0.0f;
    float dispersion = 0.0f;
    Toggle fill = true;
};
inline constexpr auto lens_distortion_rows = describe(
    field<&LensDistortion::lens_distortion>(
        "Coefficient of the squared distance from the centre: above 0 a barrel, below 0 a pincushion.", {-0.3, 1}),
    field<&LensDistortion::quartic>("Coefficient of its fourth power: bends the corners alone.", {-0.2, 1}),
    field<&LensDistortion::dispersion>(
        "Added to the first coefficient for red and taken from it for blue: coloured fringes.", {-0.1, 0.1}),
    field<&LensDistortion::fill>("Whether the picture is scaled to fill its frame, no more and no less."));

/// r' = scale * r (1 + k[channel] r^2 + quartic r^4), with r = 1 in a corner: where each channel of the pixel at r is
/// read.
struct LensDistortionWay {
    std::array<float, 2> half_size{};  ///< of the picture, where its half diagonal is 1
    std::array<float, 3> k{};
    float quartic = 0;
    float scale = 1;
};
[[nodiscard]] LensDistortionWay lens_distortion_way(const LensDistortion& lens, VkExtent2D extent);

[[nodiscard]] const EffectInfo& effect_info(const LensDistortion&);

}  // namespace darkroom
