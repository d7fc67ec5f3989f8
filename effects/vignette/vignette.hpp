// SPDX-License-Identifier: MIT
#pragma once
// Vignette: darkens the corners of the picture. Elliptical on wide pictures, like the lens of a wide frame.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Vignette {
    /// Darkening of the corners: their factor is 1 - intensity. [0, 1]
    float intensity = 0.3f;
    /// Exponent of the falloff; a larger one keeps more of the middle untouched. [0.1, 16]
    float smoothness = 2.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Vignette&);

}  // namespace darkroom
