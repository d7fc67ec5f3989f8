// SPDX-License-Identifier: MIT
// The picture where the layer is bright, at a quarter of the size: four bilinear taps of each.
#include "shared/sanitize.glsl"

vec3 classic_bloom_tap(vec2 uv) {
    vec3 color = sanitize_light(sample_linear(classic_bloom_picture, uv).rgb);
    return color * clamp(sample_linear(classic_bloom_source, uv).r, 0.0, 1.0);
}

vec4 shade(Pixel pixel) {
    vec2 reach = 0.25 / vec2(pixel.size);
    vec3 sum = classic_bloom_tap(pixel.uv - reach) + classic_bloom_tap(pixel.uv + vec2(reach.x, -reach.y)) +
               classic_bloom_tap(pixel.uv + vec2(-reach.x, reach.y)) + classic_bloom_tap(pixel.uv + reach);
    return vec4(0.25 * sum, 1.0);
}
