// SPDX-License-Identifier: MIT
// The half-size picture at full size, with the pixel's own alpha.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    return vec4(sample_linear(gaussian_blur_small, pixel.uv).rgb,
                sanitize(load(gaussian_blur_picture, pixel.texel)).a);
}
