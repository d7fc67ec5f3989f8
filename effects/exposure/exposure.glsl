// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear

vec4 exposure(vec4 color, Pixel pixel, Exposure parameters) {
    return vec4(color.rgb * parameters.exposure, color.a);
}
