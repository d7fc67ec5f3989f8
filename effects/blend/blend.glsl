// SPDX-License-Identifier: MIT
// Any domain, the same for both pictures.
#include "shared/blend_modes.glsl"

vec4 blend(vec4 color, Pixel pixel, Blend parameters) {
    vec3 layer = blend_second(pixel).rgb;
    return vec4(mix(color.rgb, blend_colors(color.rgb, layer, parameters.mode), parameters.amount), color.a);
}
