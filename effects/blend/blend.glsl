// SPDX-License-Identifier: MIT
// Any domain, the same for both pictures.
#include "shared/blend_modes.glsl"

vec4 blend(vec4 color, Pixel pixel, Blend parameters) {
    vec3 layer = blend_second(pixel).rgb;
    vec3 blended = blend_colors(color.rgb, layer, parameters.mode);
    // Not mix(): some GPUs add amount * (blended - color), which at 1 is not blended to the last bit, and loops drift.
    return vec4(color.rgb * (1.0 - parameters.amount) + blended * parameters.amount, color.a);
}
