// SPDX-License-Identifier: MIT
// The four levels at a quarter of the size, weighed, and raised to a power that leaves only strong light.

vec4 shade(Pixel pixel) {
    vec3 sum = 0.32 * sample_linear(arena_bloom_level_0, pixel.uv).rgb +
               0.10 * sample_linear(arena_bloom_level_1, pixel.uv).rgb +
               0.20 * sample_linear(arena_bloom_level_2, pixel.uv).rgb +
               0.25 * sample_linear(arena_bloom_level_3, pixel.uv).rgb;
    return vec4(pow(clamp(sum, 0.0, 1.0), vec3(2.2)), 1.0);
}
