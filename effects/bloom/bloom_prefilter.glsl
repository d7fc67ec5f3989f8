// SPDX-License-Identifier: MIT
// The scene to level 0: 13 bilinear taps, averaged as five overlapping boxes, then the threshold. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.
#include "shared/sanitize.glsl"

vec3 bloom_tap(vec2 uv) {
    return max(sanitize(sample_linear(bloom_source, uv)).rgb, 0.0);
}

// Brian Karis, "Tone mapping" (2013): average by 1 / (1 + luminance). As in Jorge Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare" (2014), a box is the unit; unlike there, the sum is divided by the sum of weights.
vec4 bloom_box(vec3 sum, float weight) {
    vec3 mean = 0.25 * sum;
    float luminance = dot(mean, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mean, 1.0) * (weight / (1.0 + custom[1].x * luminance));
}

vec4 shade(Pixel pixel) {
    // Half a texel of the output is one of the source, and a little more on odd sizes; there, see bloom_downsample.glsl.
    ivec2 extent = size(bloom_source);
    bool is_odd = (extent.x & extent.y & 1) == 1;
    vec2 outer = (is_odd ? vec2(1.0, 0.5) : vec2(1.0)) / vec2(pixel.size);
    vec2 inner = (is_odd ? vec2(0.5, 0.75) : vec2(0.5)) / vec2(pixel.size);
    vec2 uv = pixel.uv;
    vec3 top_left = bloom_tap(uv - outer);
    vec3 top = bloom_tap(uv + outer * vec2(0, -1));
    vec3 top_right = bloom_tap(uv + outer * vec2(1, -1));
    vec3 left = bloom_tap(uv + outer * vec2(-1, 0));
    vec3 centre = bloom_tap(uv);
    vec3 right = bloom_tap(uv + outer * vec2(1, 0));
    vec3 bottom_left = bloom_tap(uv + outer * vec2(-1, 1));
    vec3 bottom = bloom_tap(uv + outer * vec2(0, 1));
    vec3 bottom_right = bloom_tap(uv + outer);
    vec3 middle = bloom_tap(uv - inner) + bloom_tap(uv + inner * vec2(1, -1)) + bloom_tap(uv + inner * vec2(-1, 1)) +
                  bloom_tap(uv + inner);

    vec4 total = bloom_box(middle, 0.5) + bloom_box(top_left + top + left + centre, 0.125) +
                 bloom_box(top_right + top + right + centre, 0.125) +
                 bloom_box(bottom_left + bottom + left + centre, 0.125) +
                 bloom_box(bottom_right + bottom + right + centre, 0.125);
    vec3 color = total.rgb / total.a;

    float threshold = custom[0].x;
    float knee = custom[0].y;
    float brightness = max(color.r, max(color.g, color.b));
    float soft = clamp(brightness - threshold + knee, 0.0, 2.0 * knee);
    soft = soft * soft / (4.0 * knee + 1e-5);
    float weight = max(soft, brightness - threshold) / max(brightness, 1e-5);
    return vec4(min(color * weight, custom[0].z) * custom[0].w, 1.0);
}
