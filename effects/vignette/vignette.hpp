// SPDX-License-Identifier: MIT
#pragma once
// Vignette: darkens the corners of the picture. Elliptical on wide pictures, like the lens of a wide frame.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Vignette {
    /// How much the corners darken: the corner's factor is 1 - intensity. [0, 1]
    float intensity = 0.3f;
    /// Exponent of the falloff: larger keeps more of the middle untouched. [0.1, 16]
    float smoothness = 2.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Vignette&);

}  // namespace darkroom
