// SPDX-License-Identifier: MIT
// Device depth to planar distance, by custom[0] and custom[1].x.
#include "shared/planar_distance.glsl"

vec4 shade(Pixel pixel) { return vec4(planar_distance(load(shared_depth, pixel.texel).r, custom[0], custom[1].x)); }
