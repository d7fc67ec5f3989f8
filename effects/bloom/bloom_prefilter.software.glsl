// SPDX-License-Identifier: MIT
// bloom_prefilter.glsl by loads of the 6x6 texels under the taps, where all lie on corners, which the pixels of a quad
// share.
#include "shared/sanitize.glsl"
#include "bloom_quad.glsl"
#include "bloom_prefilter_taps.glsl"
#include "bloom_bright_part.glsl"

// A tap on a corner of texels. What is cleaned is the mean, as after filtering: a texel below 0 takes from its neighbours.
vec3 bloom_mean(vec3 upper, vec3 lower) {
    return sanitize_light(0.25 * (upper + lower));
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

BloomTaps bloom_taps(Pixel pixel) {
    if (has_quads && input_is_twice) return bloom_by_quads(pixel);
    if (input_is_twice) return bloom_by_loads(pixel);
    return bloom_by_taps(pixel);
}

vec4 shade(Pixel pixel) {
    return bloom_bright_part(bloom_average(bloom_taps(pixel)));
}
