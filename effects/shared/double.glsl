// SPDX-License-Identifier: MIT
// A picture to one of twice its size, by bilinear taps.

vec4 shade(Pixel pixel) {
    return sample_linear(double_input, pixel.uv);
}
