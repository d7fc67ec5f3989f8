// SPDX-License-Identifier: MIT
#pragma once
// Contrast and gamma of the finished picture with its interface: the two sliders of a game's display menu.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ContrastGamma {
    float contrast = 1.0f;
    float gamma = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ContrastGamma&);

}  // namespace darkroom
