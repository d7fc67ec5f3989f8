// SPDX-License-Identifier: MIT
#include "kawase_blur_taps.glsl"
#include "kawase_blur_up.glsl"

vec4 shade(Pixel pixel) {
    return vec4(kawase_blur_doubled(pixel.uv), 1.0);
}
