// SPDX-License-Identifier: MIT
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
