// SPDX-License-Identifier: MIT
#pragma once
// Vignette: darkens the corners of the picture. Elliptical on wide pictures, like the lens of a wide frame.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Vignette {
    float intensity = 0.3f;
    float smoothness = 2.0f;
};
inline constexpr auto vignette_rows = describe(
    field<&Vignette::intensity>("How much the corners darken: the corner's factor is 1 - intensity.", {0, 1})
        .as_amount(),
    field<&Vignette::smoothness>("Exponent of the falloff: larger keeps more of the middle untouched.", {0.1, 16}));

[[nodiscard]] const EffectInfo& effect_info(const Vignette&);

}  // namespace darkroom
