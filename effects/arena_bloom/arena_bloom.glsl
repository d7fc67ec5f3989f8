// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.

vec4 arena_bloom(vec4 color, Pixel pixel, ArenaBloom parameters) {
    return vec4(color.rgb + parameters.intensity * sample_linear(arena_bloom_glow, pixel.uv).rgb, color.a);
}
