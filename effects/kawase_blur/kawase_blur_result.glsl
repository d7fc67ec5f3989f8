// SPDX-License-Identifier: MIT
// The last doubling, with the pixel's own alpha.
#include "kawase_blur_taps.glsl"
#include "kawase_blur_up.glsl"

vec4 shade(Pixel pixel) {
    return vec4(kawase_blur_doubled(pixel.uv), sanitize(load(kawase_blur_picture, pixel.texel)).a);
}
