// SPDX-License-Identifier: MIT
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
