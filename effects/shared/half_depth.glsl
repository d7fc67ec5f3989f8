// SPDX-License-Identifier: MIT
// The planar distance of the first pixel of every two by two: a mean would lie on no surface. By custom[0] and custom[1].x.
#include "shared/planar_distance.glsl"

vec4 shade(Pixel pixel) { return vec4(planar_distance(load(shared_depth, pixel.texel * 2).r, custom[0], custom[1].x)); }
