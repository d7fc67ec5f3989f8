// SPDX-License-Identifier: MIT
// One direction of the blur of a smaller picture.
#include "gaussian_blur_sum.glsl"
#include "gaussian_blur_taps.glsl"

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    return vec4(gaussian_blur_sum(pixel, own, int(custom[0].y), true), own.a);
}
