// SPDX-License-Identifier: MIT
#pragma once
// Fog: distance, and if wanted height, hide the scene behind a colour. It is a curve over the depth buffer: light does
// not scatter in it, and what writes no depth gets the fog of what lies behind.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Fog {
    Rgb color = {0.7f, 0.75f, 0.82f};
    float density = 0.02f;
    float start = 5.0f;
    float end = 100.0f;
    Toggle height_enabled = false;
    float height_falloff = 0.1f;
    float height_origin = 0.0f;
    Toggle sky = false;
};
inline constexpr auto fog_rows = describe(
    field<&Fog::color>("Colour of full fog, in the domain of the picture that the fog is laid over.", {0, 65504}),
    field<&Fog::density>("How quickly it thickens behind `start`; 0 is none.", {0, 1000}, unit::per_metre).as_amount(),
    field<&Fog::start>("Where it begins.", {0, 1e6}, unit::metres),
    field<&Fog::end>("Where it is full; must lie beyond `start`.", {0.001, 1e9}, unit::metres),
    field<&Fog::height_enabled>("Does it thin with height."),
    field<&Fog::height_falloff>("How quickly it thins above `height_origin`.", {0, 1000}, unit::per_metre)
        .as_amount_of<&Fog::height_enabled>(),
    field<&Fog::height_origin>("World height up to which it has its full density.", {-1e6, 1e6}, unit::metres),
    field<&Fog::sky>("Does it cover the sky, too: full, at every height."));

[[nodiscard]] const EffectInfo& effect_info(const Fog&);

}  // namespace darkroom
