// SPDX-License-Identifier: MIT
#pragma once
// Radial blur: the picture smears away from a centre, as at speed; what is near it stays sharp. It knows no motion.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct RadialBlur {
    float radial_blur = 0.0f;
    Vec2 center{0.5f, 0.5f};
};

[[nodiscard]] const EffectInfo& effect_info(const RadialBlur&);

}  // namespace darkroom
