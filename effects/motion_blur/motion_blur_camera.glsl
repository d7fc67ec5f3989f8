// SPDX-License-Identifier: MIT
// The same for a world that stands still: custom[2 ... 4] = x, y and w of a moment ago, of a point of view space;
// custom[5] = (size of the picture, motion of a still point by the jitter).
#include "shared/camera.glsl"
#include "shared/sanitize.glsl"
#include "motion_blur_reach.glsl"

vec4 shade(Pixel pixel) {
    float inverse = motion_blur_inverse(load(motion_blur_depth, motion_blur_place(pixel)).r);
    vec2 uv = (vec2(motion_blur_first(pixel)) + 0.5) / custom[5].xy;
    // The sky turns with the camera and does not come nearer.
    vec4 point = vec4(view_position(uv, 1.0 / max(inverse, 1.0 / sky_distance)), 1.0);
    float w = dot(custom[4], point);
    vec2 before = vec2(dot(custom[2], point), dot(custom[3], point)) / w * 0.5 + 0.5;
    // What was behind the camera has no place in the last picture.
    vec2 velocity = w > 0.0 ? (before - uv) * custom[5].xy + custom[5].zw : vec2(0.0);
    return motion_blur_reach(velocity, inverse);
}
