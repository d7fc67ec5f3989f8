// SPDX-License-Identifier: MIT
#pragma once
// Radial blur: the picture smears away from its centre, as at speed; the middle stays sharp. It knows no motion.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct RadialBlur {
    float radial_blur = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const RadialBlur&);

}  // namespace darkroom
