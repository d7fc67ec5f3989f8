// SPDX-License-Identifier: MIT
// Full size: colour, in numbers that may be spread, and circle of every pixel.
#include "shared/sanitize.glsl"
#include "depth_of_field_circle.glsl"

vec4 shade(Pixel pixel) {
    return vec4(sanitize(load(depth_of_field_picture, pixel.texel)).rgb,
                depth_of_field_to_blur(depth_of_field_circle(load(depth_of_field_depth, pixel.texel).r)));
}
