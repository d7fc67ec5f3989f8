// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear

vec4 auto_exposure(vec4 color, Pixel pixel, AutoExposure parameters) {
    return vec4(color.rgb * auto_exposure_adapted[0], color.a);
}
