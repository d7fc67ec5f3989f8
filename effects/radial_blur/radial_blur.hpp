// SPDX-License-Identifier: MIT
#pragma once
// Radial blur: the picture smears away from its centre, as at speed; the middle stays sharp. It knows no motion.

#include <darkroom/effect.hpp>

namespace darkroom {

struct RadialBlur {
    float radial_blur = 0.0f;
};
inline constexpr auto radial_blur_rows = describe(
    field<&RadialBlur::radial_blur>("Length and strength of the streaks; 0.001 and less is none.", {0, 4}).as_amount());

[[nodiscard]] const EffectInfo& effect_info(const RadialBlur&);

}  // namespace darkroom
