// SPDX-License-Identifier: MIT
#pragma once
// Sharpening that adapts to contrast: each pixel moves away from its four neighbours as far as the range of values
// allows, and never beyond what they and it span. It gives back what a filter took; it cannot tell detail from noise,
// so grain belongs behind it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Sharpen {
    /// Strength in stops: 0 is all that the method allows, each stop less halves it. [-8, 0]
    float stops = -0.5f;
};

[[nodiscard]] const EffectInfo& effect_info(const Sharpen&);

}  // namespace darkroom
