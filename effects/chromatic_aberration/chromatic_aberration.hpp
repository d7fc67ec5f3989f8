// SPDX-License-Identifier: MIT
#pragma once
// Chromatic aberration of the scene: red and blue are drawn a little larger and smaller than green, as by a simple
// lens. Three taps, no spectrum.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct ChromaticAberration {
    /// How far red and blue part: 0.012 of the distance from the centre for each 1; 0.001 and less is none. [0, 8]
    float chromatic_aberration = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const ChromaticAberration&);

}  // namespace darkroom
