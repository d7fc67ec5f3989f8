// SPDX-License-Identifier: MIT
// A Gaussian along one axis. custom[0] = (a texel's step, weight of the middle, pairs of taps); then two pairs a vector: how
// many steps away a bilinear tap lies, and what it counts.

vec4 shade(Pixel pixel) {
    vec3 sum = sample_linear(line_source, pixel.uv).rgb * custom[0].z;
    int pairs = int(custom[0].w);
    for (int i = 0; i < pairs; ++i) {
        vec2 tap = (i & 1) == 0 ? custom[1 + i / 2].xy : custom[1 + i / 2].zw;
        vec2 reach = custom[0].xy * tap.x;
        sum += (sample_linear(line_source, pixel.uv - reach).rgb + sample_linear(line_source, pixel.uv + reach).rgb) *
               tap.y;
    }
    return vec4(sum, 1.0);
}
