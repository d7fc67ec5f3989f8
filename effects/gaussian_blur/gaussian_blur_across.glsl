// SPDX-License-Identifier: MIT
// The blur along the lines, in the picture's own domain. NaN counts as 0, infinity as 65504.
#include "gaussian_blur_sum.glsl"
#include "gaussian_blur_taps.glsl"
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    // In lean kernels the radius is a literal, and the loop is unrolled.
    int vectors = gaussian_blur_vectors();
    vec3 sum = gaussian_blur_sum(pixel, own, vectors, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = gaussian_blur_sum(pixel, own, vectors, false);
    return vec4(clamp(sum, -65504.0, 65504.0), sanitize(own).a);
}
