// SPDX-License-Identifier: MIT
#pragma once
// LensDirt: dust and drops on the front of the lens, out of focus, which shine where bright light is near. It adds
// light alone: what dirt takes from the picture is not seen.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct LensDirt {
    /// Share of the surrounding light that shines in white dirt. [0, 64]
    float intensity = 3.0f;
    /// Light above this value makes dirt shine. [0, 65504]
    float threshold = 1.0f;
    /// Standard deviation of the surrounding light, in a picture of 1080 lines. [20, 128] px
    float radius = 80.0f;
    /// Picture of the dirt from 0 to 1, stretched over the whole; without one there are discs of dust.
    Resource dirt;
};

[[nodiscard]] const EffectInfo& effect_info(const LensDirt&);

}  // namespace darkroom
