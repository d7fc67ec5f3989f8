// SPDX-License-Identifier: MIT
// A picture to one of twice its size.

vec4 shade(Pixel pixel) {
    return sample_linear(gaussian_blur_small, pixel.uv);
}
