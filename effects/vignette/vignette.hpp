// SPDX-License-Identifier: MIT
#pragma once
// Vignette: darkens the corners of the picture. Elliptical on wide pictures, like the lens of a wide frame.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Vignette {
    float intensity = 0.3f;
    float smoothness = 2.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Vignette&);

}  // namespace darkroom
