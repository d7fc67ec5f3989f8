// SPDX-License-Identifier: MIT
#pragma once
// Radial blur: the picture smears away from a centre, as at speed; what is near it stays sharp. It knows no motion.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct RadialBlur {
    /// Length and strength of the streaks; 0.001 and less do nothing. [0, 4]
    float radial_blur = 0.0f;
    /// Point that the streaks run from: (0, 0) is the top left of the picture, (1, 1) the bottom right. [-1, 2]
    Vec2 center{0.5f, 0.5f};
};

[[nodiscard]] const EffectInfo& effect_info(const RadialBlur&);

}  // namespace darkroom
