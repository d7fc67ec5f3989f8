// SPDX-License-Identifier: MIT
#pragma once
// Chromatic aberration of the scene: red and blue are drawn a little larger and smaller than green, as by a simple
// lens. Three taps, no spectrum.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ChromaticAberration {
    /// Separation of red and blue: each 1 moves them by 0.012 of the distance from the centre; 0.001 and less do
    /// nothing. [0, 8]
    float chromatic_aberration = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ChromaticAberration&);

}  // namespace darkroom
