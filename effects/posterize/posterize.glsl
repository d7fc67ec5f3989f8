// SPDX-License-Identifier: MIT
// Any domain: the levels are even in the numbers that it gets.
#include "shared/sanitize.glsl"

vec4 posterize(vec4 color, Pixel pixel, Posterize parameters) {
    vec3 rgb = sanitize(color).rgb;
    float steps = float(parameters.levels - 1);
    if (parameters.mode == Posterize_mode_channel) {
        rgb = floor(rgb * steps + 0.5) / steps;
    } else {
        // ITU-R BT.709.
        float luma = dot(rgb, vec3(0.2126, 0.7152, 0.0722));
        rgb = luma > 0.0 ? rgb * (floor(luma * steps + 0.5) / (steps * luma)) : vec3(0.0);
    }
    return vec4(rgb, color.a);
}
