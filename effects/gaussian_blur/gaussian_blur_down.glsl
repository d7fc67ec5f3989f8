// SPDX-License-Identifier: MIT
// The blur along the columns, of what gaussian_blur_across.glsl made.
#include "gaussian_blur_sum.glsl"
#include "gaussian_blur_taps.glsl"

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    return vec4(gaussian_blur_sum(pixel, own, gaussian_blur_vectors(), true), own.a);
}
