// SPDX-License-Identifier: MIT
// The motion of every pixel, or of the first of every two by two, by the frame's own velocity.
#include "shared/sanitize.glsl"
#include "motion_blur_reach.glsl"

vec4 shade(Pixel pixel) {
    ivec2 texel = pixel.texel * int(custom[0].z);
    return motion_blur_reach(load(motion_blur_velocity, texel).rg,
                             motion_blur_inverse(load(motion_blur_depth, texel).r));
}
