// SPDX-License-Identifier: MIT
// Half size: the mean of those of every two by two pixels that are as far away as the first, whose motion the texel has.
#include "shared/sanitize.glsl"
#include "motion_blur_reach.glsl"

vec4 shade(Pixel pixel) {
    ivec2 first = pixel.texel * 2, last = min(first + 1, size(motion_blur_picture) - 1);
    // In the order of a gather: (0,1), (1,1), (1,0), (0,0).
    vec4 depth = gather_red(motion_blur_depth, (vec2(first) + 1.0) / vec2(size(motion_blur_depth)));
    vec4 inverse = (depth * custom[1].z + custom[1].w) / (depth * custom[1].x + custom[1].y);
    // Sky is like sky, whose inverse may be 0. What is no number compares as unlike.
    inverse = mix(inverse, vec4(0.0), equal(depth, vec4(custom[0].w)));
    vec4 weight = vec4(lessThanEqual(abs(inverse - inverse.w), 0.1 * inverse));
    weight.w = 1.0;
    vec4 sum = load(motion_blur_picture, first);
    sum += load(motion_blur_picture, ivec2(first.x, last.y)) * weight.x;
    sum += load(motion_blur_picture, last) * weight.y + load(motion_blur_picture, ivec2(last.x, first.y)) * weight.z;
    return sanitize(sum / dot(weight, vec4(1.0)));
}
