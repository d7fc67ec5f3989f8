// SPDX-License-Identifier: MIT
// The levels at a quarter of the size, weighed, and raised to a power that leaves only strong light. custom: the weights of
// a glow in parts of the height.

vec4 shade(Pixel pixel) {
    vec4 weights = vec4(0.32, 0.10, 0.20, 0.25);
    vec3 sum = vec3(0.0);
    if (arena_bloom_parameters().reach == ArenaBloom_reach_height) {
        weights = custom[0];
        sum = custom[1].x * sample_linear(arena_bloom_level_4, pixel.uv).rgb +
              custom[1].y * sample_linear(arena_bloom_level_5, pixel.uv).rgb;
    }
    sum += weights.x * sample_linear(arena_bloom_level_0, pixel.uv).rgb +
           weights.y * sample_linear(arena_bloom_level_1, pixel.uv).rgb +
           weights.z * sample_linear(arena_bloom_level_2, pixel.uv).rgb +
           weights.w * sample_linear(arena_bloom_level_3, pixel.uv).rgb;
    return vec4(pow(clamp(sum, 0.0, 1.0), vec3(2.2)), 1.0);
}
