// SPDX-License-Identifier: MIT
// Along the lines of the small picture, a texel apart, into one of twice its size. custom: the weights, from the middle on,
// and last how many there are.

vec4 shade(Pixel pixel) {
    float reach = 1.0 / float(size(classic_bloom_small).x);
    vec3 sum = sample_linear(classic_bloom_small, pixel.uv).rgb * custom[0].x;
    ClassicBloom parameters = classic_bloom_parameters();
    int taps = parameters.reach == ClassicBloom_reach_pixels ? (parameters.radius + 3) / 4 : int(custom[16].w);
    for (int i = 1; i <= taps; ++i) {
        vec2 offset = vec2(float(i) * reach, 0.0);
        sum += (sample_linear(classic_bloom_small, pixel.uv - offset).rgb +
                sample_linear(classic_bloom_small, pixel.uv + offset).rgb) *
               custom[i / 4][i % 4];
    }
    return vec4(sum, 1.0);
}
