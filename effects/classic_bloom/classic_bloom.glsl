// SPDX-License-Identifier: MIT
// Any domain. Along the columns of the wide picture, two of its texels apart, which is one of the small picture's: at full
// size, and added.

vec4 classic_bloom(vec4 color, Pixel pixel, ClassicBloom parameters) {
    float reach = 2.0 / float(size(classic_bloom_wide).y);
    vec3 sum = sample_linear(classic_bloom_wide, pixel.uv).rgb * classic_bloom_custom(0).x;
    int taps =
        parameters.reach == ClassicBloom_reach_pixels ? (parameters.radius + 3) / 4 : int(classic_bloom_custom(16).w);
    for (int i = 1; i <= taps; ++i) {
        vec2 offset = vec2(0.0, float(i) * reach);
        sum += (sample_linear(classic_bloom_wide, pixel.uv - offset).rgb +
                sample_linear(classic_bloom_wide, pixel.uv + offset).rgb) *
               classic_bloom_custom(i / 4)[i % 4];
    }
    return vec4(color.rgb + parameters.intensity * sum, color.a);
}
