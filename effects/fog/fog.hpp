// SPDX-License-Identifier: MIT
#pragma once
// Fog: distance, and if wanted height, hide the scene behind a colour. It is a curve over the depth buffer: light does
// not scatter in it, and what writes no depth gets the fog of what lies behind.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Fog {
    Rgb color = {0.7f, 0.75f, 0.82f};
    float density = 0.02f;
    float start = 5.0f;
    float end = 100.0f;
    Toggle height_enabled = false;
    float height_falloff = 0.1f;
    float height_origin = 0.0f;
    Toggle sky = false;
    float horizon = 10.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Fog&);

}  // namespace darkroom
