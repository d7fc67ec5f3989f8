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
    /// Rate at which the fog thickens beyond `start`; 0 is no fog. [0, 1000] 1/m
    float density = 0.005f;
    /// Distance at which the fog begins. [0, 1000000] m
    float start = 5.0f;
    /// Distance at which the fog is full; it must lie beyond `start`. [0.001, 1000000000] m
    float end = 10000.0f;
    /// Thins the fog with height.
    Toggle height_enabled = false;
    /// Height that counts: integral takes the whole way to the eye, end_point the height of the surface alone.
    FogHeight height_form = FogHeight::Integral;
    /// Rate at which the fog thins above `height_origin`. [0, 1000] 1/m
    float height_falloff = 0.1f;
    /// World height up to which the fog has its full density. [-1000000, 1000000] m
    float height_origin = 0.0f;
    /// Covers the sky with full fog, at every height.
    Toggle sky = false;
    /// Angle above the horizon over which fog fades out of the sky, so that land and sky meet; at 0 it ends at the
    /// horizon. [0, 90] deg
    float horizon = 10.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Fog&);

}  // namespace darkroom
