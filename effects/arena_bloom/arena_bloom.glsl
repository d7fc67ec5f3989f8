// SPDX-License-Identifier: MIT
#part bright
// The bright part at a quarter of the size, scene_linear: four bilinear taps read the 16 texels under the output's pixel.
// With m the largest channel, what it has above half of 0.925 counts sixfold, in the colour's own hue.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    vec2 reach = 0.25 / vec2(pixel.size);
    vec4 color = 0.25 * (sanitize(sample_linear(arena_bloom_source, pixel.uv - reach)) +
                         sanitize(sample_linear(arena_bloom_source, pixel.uv + vec2(reach.x, -reach.y))) +
                         sanitize(sample_linear(arena_bloom_source, pixel.uv + vec2(-reach.x, reach.y))) +
                         sanitize(sample_linear(arena_bloom_source, pixel.uv + reach)));
    bool is_masked = arena_bloom_parameters().source_kind == ArenaBloom_source_kind_masked;
    color = is_masked ? clamp(color, 0.0, 1.0) : vec4(max(color.rgb, 0.0), 1.0);
    float largest = max(max(color.r, color.g), max(color.b, 0.001));
    float gain = max(largest - 0.925 * 0.5, 0.0) * 6.0 * color.a;
    return vec4(min(color.rgb / largest * gain, 65504.0), 1.0);
}

#part combine
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

#part end
// scene_linear -> scene_linear.

vec4 arena_bloom(vec4 color, Pixel pixel, ArenaBloom parameters) {
    return vec4(color.rgb + parameters.intensity * sample_linear(arena_bloom_glow, pixel.uv).rgb, color.a);
}
