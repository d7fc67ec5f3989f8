// SPDX-License-Identifier: MIT
#part bright
// What glows, at a quarter of the size: the mean of four bilinear taps, which read the 16 texels under the output's pixel.
// In the picture's own domain.
#include "shared/sanitize.glsl"

vec3 classic_bloom_tap(vec2 uv, ClassicBloom parameters) {
    vec3 color = sanitize_light(sample_linear(classic_bloom_source, uv).rgb);
    // ITU-R BT.709.
    float luminance = dot(color, vec3(0.2126, 0.7152, 0.0722));
    float brightness = max(color.r, max(color.g, color.b));
    float kept = parameters.source_kind == ClassicBloom_source_kind_high_pass
                     ? (luminance >= parameters.threshold ? 1.0 : 0.0)
                     : max(brightness - parameters.threshold, 0.0) / max(brightness, 1e-6);
    return color * kept;
}

vec4 shade(Pixel pixel) {
    ClassicBloom parameters = classic_bloom_parameters();
    vec2 reach = 0.25 / vec2(pixel.size);
    vec3 sum = classic_bloom_tap(pixel.uv - reach, parameters) +
               classic_bloom_tap(pixel.uv + vec2(reach.x, -reach.y), parameters) +
               classic_bloom_tap(pixel.uv + vec2(-reach.x, reach.y), parameters) +
               classic_bloom_tap(pixel.uv + reach, parameters);
    return vec4(0.25 * sum, 1.0);
}

#part horizontal
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

#part layer
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

#part end
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
