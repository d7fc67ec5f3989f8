// SPDX-License-Identifier: MIT
// The scene to level 0: 13 bilinear taps, averaged as five overlapping boxes, then the threshold. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.
#include "shared/sanitize.glsl"

// The taps, cleaned; of the four inner ones only the sum is used.
struct BloomTaps {
    vec3 top_left, top, top_right;
    vec3 left, centre, right;
    vec3 bottom_left, bottom, bottom_right;
    vec3 middle;
};

vec3 bloom_tap(vec2 uv) {
    return sanitize_light(sample_linear(bloom_source, uv).rgb);
}

BloomTaps bloom_by_taps(Pixel pixel) {
    // Half a texel of the output is one of the source, and a little more on odd sizes; there, see bloom_downsample.glsl.
    ivec2 extent = size(bloom_source);
    bool is_odd = (extent.x & extent.y & 1) == 1;
    vec2 outer = (is_odd ? vec2(1.0, 0.5) : vec2(1.0)) / vec2(pixel.size);
    vec2 inner = (is_odd ? vec2(0.5, 0.75) : vec2(0.5)) / vec2(pixel.size);
    vec2 uv = pixel.uv;
    BloomTaps taps;
    taps.top_left = bloom_tap(uv - outer);
    taps.top = bloom_tap(uv + outer * vec2(0, -1));
    taps.top_right = bloom_tap(uv + outer * vec2(1, -1));
    taps.left = bloom_tap(uv + outer * vec2(-1, 0));
    taps.centre = bloom_tap(uv);
    taps.right = bloom_tap(uv + outer * vec2(1, 0));
    taps.bottom_left = bloom_tap(uv + outer * vec2(-1, 1));
    taps.bottom = bloom_tap(uv + outer * vec2(0, 1));
    taps.bottom_right = bloom_tap(uv + outer);
    taps.middle = bloom_tap(uv - inner) + bloom_tap(uv + inner * vec2(1, -1)) + bloom_tap(uv + inner * vec2(-1, 1)) +
                  bloom_tap(uv + inner);
    return taps;
}

// Sums of neighbours in a row of six texels: 0 1, 2 3 and 4 5 lie under outer taps, 1 2 and 3 4 under inner ones.
struct BloomRow {
    vec3 left, centre, right;
    vec3 inner_left, inner_right;
};

BloomRow bloom_row(ivec2 first) {
    vec3 texel_0 = load_clamped(bloom_source, first).rgb;
    vec3 texel_1 = load_clamped(bloom_source, first + ivec2(1, 0)).rgb;
    vec3 texel_2 = load_clamped(bloom_source, first + ivec2(2, 0)).rgb;
    vec3 texel_3 = load_clamped(bloom_source, first + ivec2(3, 0)).rgb;
    vec3 texel_4 = load_clamped(bloom_source, first + ivec2(4, 0)).rgb;
    vec3 texel_5 = load_clamped(bloom_source, first + ivec2(5, 0)).rgb;
    return BloomRow(texel_0 + texel_1, texel_2 + texel_3, texel_4 + texel_5, texel_1 + texel_2, texel_3 + texel_4);
}

vec3 bloom_mean(vec3 upper, vec3 lower) {
    return sanitize_light(0.25 * (upper + lower));
}

// The same taps where all lie on corners of texels: each is the mean of the 2x2 around it, and all cover 6x6. What is
// cleaned is the mean, as after filtering: a texel below 0 takes from its neighbours in both forms.
BloomTaps bloom_by_loads(Pixel pixel) {
    ivec2 first = pixel.texel * 2 - 2;
    BloomRow row_0 = bloom_row(first);
    BloomRow row_1 = bloom_row(first + ivec2(0, 1));
    BloomRow row_2 = bloom_row(first + ivec2(0, 2));
    BloomRow row_3 = bloom_row(first + ivec2(0, 3));
    BloomRow row_4 = bloom_row(first + ivec2(0, 4));
    BloomRow row_5 = bloom_row(first + ivec2(0, 5));
    BloomTaps taps;
    taps.top_left = bloom_mean(row_0.left, row_1.left);
    taps.top = bloom_mean(row_0.centre, row_1.centre);
    taps.top_right = bloom_mean(row_0.right, row_1.right);
    taps.left = bloom_mean(row_2.left, row_3.left);
    taps.centre = bloom_mean(row_2.centre, row_3.centre);
    taps.right = bloom_mean(row_2.right, row_3.right);
    taps.bottom_left = bloom_mean(row_4.left, row_5.left);
    taps.bottom = bloom_mean(row_4.centre, row_5.centre);
    taps.bottom_right = bloom_mean(row_4.right, row_5.right);
    taps.middle = bloom_mean(row_1.inner_left, row_2.inner_left) + bloom_mean(row_1.inner_right, row_2.inner_right) +
                  bloom_mean(row_3.inner_left, row_4.inner_left) + bloom_mean(row_3.inner_right, row_4.inner_right);
    return taps;
}

// Brian Karis, "Tone mapping" (2013): average by 1 / (1 + luminance). As in Jorge Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare" (2014), a box is the unit; unlike there, the sum is divided by the sum of weights.
vec4 bloom_box(vec3 sum, float weight) {
    vec3 mean = 0.25 * sum;
    float luminance = dot(mean, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mean, 1.0) * (weight / (1.0 + custom[1].x * luminance));
}

vec3 bloom_average(BloomTaps taps) {
    vec4 total = bloom_box(taps.middle, 0.5) + bloom_box(taps.top_left + taps.top + taps.left + taps.centre, 0.125) +
                 bloom_box(taps.top_right + taps.top + taps.right + taps.centre, 0.125) +
                 bloom_box(taps.bottom_left + taps.bottom + taps.left + taps.centre, 0.125) +
                 bloom_box(taps.bottom_right + taps.bottom + taps.right + taps.centre, 0.125);
    return total.rgb / total.a;
}

vec4 bloom_bright_part(vec3 color) {
    float threshold = custom[0].x;
    float knee = custom[0].y;
    float brightness = max(color.r, max(color.g, color.b));
    float soft = clamp(brightness - threshold + knee, 0.0, 2.0 * knee);
    soft = soft * soft / (4.0 * knee + 1e-5);
    float weight = max(soft, brightness - threshold) / max(brightness, 1e-5);
    return vec4(min(color * weight, custom[0].z) * custom[0].w, 1.0);
}

vec4 shade(Pixel pixel) {
    if (is_software && input_is_twice) return bloom_bright_part(bloom_average(bloom_by_loads(pixel)));
    return bloom_bright_part(bloom_average(bloom_by_taps(pixel)));
}
