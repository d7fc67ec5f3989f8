// SPDX-License-Identifier: MIT
// A quarter of each side: the mean of four bilinear taps, which read the 16 texels under the output's.

vec4 shade(Pixel pixel) {
    vec2 reach = 0.25 / vec2(pixel.size);
    return 0.25 * (sample_linear(quarter_source, pixel.uv - reach) +
                   sample_linear(quarter_source, pixel.uv + vec2(reach.x, -reach.y)) +
                   sample_linear(quarter_source, pixel.uv + vec2(-reach.x, reach.y)) +
                   sample_linear(quarter_source, pixel.uv + reach));
}
