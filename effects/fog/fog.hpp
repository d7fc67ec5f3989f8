// SPDX-License-Identifier: MIT
#pragma once
// Fog: distance, and if wanted height, hide the scene behind a colour. It is a curve over the depth buffer: light does
// not scatter in it, and what writes no depth gets the fog of what lies behind.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class FogHeight : std::uint32_t {
    Integral,  ///< by all of the fog on the way to the eye
    EndPoint,  ///< by the height of what is seen alone
};

struct Fog {
    /// Colour of full fog, in the domain of the picture that the fog is laid over. [0, 65504]
    Rgb color = {0.7f, 0.75f, 0.82f};
    /// How quickly it thickens behind `start`; 0 is none. [0, 1000] 1/m
    float density = 0.005f;
    /// Where it begins. [0, 1000000] m
    float start = 5.0f;
    /// Where it is full; must lie beyond `start`. [0.001, 1000000000] m
    float end = 10000.0f;
    /// Does it thin with height.
    Toggle height_enabled = false;
    /// Whether its height counts along the whole way to the eye, or at the end of the way alone.
    FogHeight height_form = FogHeight::Integral;
    /// How quickly it thins above `height_origin`. [0, 1000] 1/m
    float height_falloff = 0.1f;
    /// World height up to which it has its full density. [-1000000, 1000000] m
    float height_origin = 0.0f;
    /// Does it cover the sky, too: full, at every height.
    Toggle sky = false;
    /// How far above the horizon it fades out of the sky, so that land and sky meet; 0: it ends there. [0, 90] deg
    float horizon = 10.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Fog&);

}  // namespace darkroom
