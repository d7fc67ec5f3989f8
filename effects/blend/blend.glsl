// SPDX-License-Identifier: MIT
// Any domain, the same for both pictures.
#include "shared/blend_modes.glsl"

vec4 blend(vec4 color, Pixel pixel, Blend parameters) {
    vec3 layer = blend_second(pixel).rgb;
    vec3 blended = blend_colors(color.rgb, layer, parameters.mode);
    // Not mix(): GLSL lets it be color + amount * (blended - color). At an amount of 1 that is not `blended` to the last
    // bit, and a picture that feeds back drifts.
    return vec4(color.rgb * (1.0 - parameters.amount) + blended * parameters.amount, color.a);
}
