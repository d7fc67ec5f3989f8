// SPDX-License-Identifier: MIT
// The scene to level 0: 13 bilinear taps, averaged as five overlapping boxes, then the threshold. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.
#include "bloom_quad.glsl"
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

// A quarter's row of four texels.
struct BloomQuarter {
    vec3 outer, centre, inner, last;  // texels 0 1, 2 3, 1 2, and 3
};

BloomQuarter bloom_quarter(ivec2 first, ivec2 inward, int row) {
    vec3 texel_0 = load_clamped(bloom_source, first + inward * ivec2(0, row)).rgb;
    vec3 texel_1 = load_clamped(bloom_source, first + inward * ivec2(1, row)).rgb;
    vec3 texel_2 = load_clamped(bloom_source, first + inward * ivec2(2, row)).rgb;
    vec3 texel_3 = load_clamped(bloom_source, first + inward * ivec2(3, row)).rgb;
    return BloomQuarter(texel_0 + texel_1, texel_2 + texel_3, texel_1 + texel_2, texel_3);
}

// Part of a mean that goes to another pixel, which takes finite numbers only. Halves are far from the bounds: these still
// outweigh the rest of the mean, which so is cleaned to what infinity and NaN, in this order, are cleaned to.
vec3 bloom_part(vec3 sum) {
    return clamp(sum, -1e6, 1e6);
}

// A tap on a corner of texels. What is cleaned is the mean, as after filtering: a texel below 0 takes from its neighbours.
vec3 bloom_mean(vec3 upper, vec3 lower) {
    return sanitize_light(0.25 * (upper + lower));
}

// The same taps where all lie on corners.
BloomTaps bloom_by_quads(Pixel pixel) {
    ivec2 first = bloom_first(pixel), inward = bloom_inward(pixel);
    BloomQuarter a = bloom_quarter(first, inward, 0), b = bloom_quarter(first, inward, 1);
    BloomQuarter c = bloom_quarter(first, inward, 2), d = bloom_quarter(first, inward, 3);
    BloomTaps taps;
    taps.top_left = bloom_mean(a.outer, b.outer);
    taps.top = bloom_mean(a.centre, b.centre);
    taps.left = bloom_mean(c.outer, d.outer);
    taps.centre = bloom_mean(c.centre, d.centre);
    taps.top_right = from_beside(taps.top);
    taps.right = from_beside(taps.centre);
    taps.bottom_left = from_below(taps.left);
    taps.bottom = from_below(taps.centre);
    taps.bottom_right = from_below(taps.right);
    vec3 side = bloom_part(b.last + c.last), lower = bloom_part(d.inner), corner = bloom_part(d.last);
    vec3 edge = corner + from_beside(corner);
    taps.middle = bloom_mean(b.inner, c.inner) + bloom_mean(side, from_beside(side)) +
                  bloom_mean(lower, from_below(lower)) + bloom_mean(edge, from_below(edge));
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
    if (has_quads && input_is_twice) return bloom_bright_part(bloom_average(bloom_by_quads(pixel)));
    return bloom_bright_part(bloom_average(bloom_by_taps(pixel)));
}
