// SPDX-License-Identifier: MIT
#pragma once
// Contrast and gamma of the finished picture with its interface: the two sliders of a game's display menu.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ContrastGamma {
    /// Factor of the encoded picture. [1, 2]
    float contrast = 1.0f;
    /// Exponent applied after the contrast: below 1 brightens. [0.1, 4]
    float gamma = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ContrastGamma&);

}  // namespace darkroom
