// SPDX-License-Identifier: MIT
// The motion of every pixel, or of the first of every two by two, by the frame's own velocity.
#include "shared/sanitize.glsl"
#include "motion_blur_reach.glsl"

vec4 shade(Pixel pixel) {
    return motion_blur_reach(load(motion_blur_velocity, motion_blur_first(pixel)).rg,
                             motion_blur_inverse(load(motion_blur_depth, motion_blur_place(pixel)).r));
}
