// SPDX-License-Identifier: MIT
// bloom_prefilter_taps.glsl by loads of the 6x6 texels under the taps, where all lie on corners, which the pixels of a quad
// share.
#include "bloom_quad.glsl"

vec3 bloom_tap(int from, vec2 place) {
    return sanitize_light(sample_linear(bloom_source, place * (0.5 / vec2(output_size()))).rgb);
}

#include "bloom_taps.glsl"

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
    taps.left.top = bloom_mean(row_0.left, row_1.left);
    taps.centre.top = bloom_mean(row_0.centre, row_1.centre);
    taps.right.top = bloom_mean(row_0.right, row_1.right);
    taps.left.middle = bloom_mean(row_2.left, row_3.left);
    taps.centre.middle = bloom_mean(row_2.centre, row_3.centre);
    taps.right.middle = bloom_mean(row_2.right, row_3.right);
    taps.left.bottom = bloom_mean(row_4.left, row_5.left);
    taps.centre.bottom = bloom_mean(row_4.centre, row_5.centre);
    taps.right.bottom = bloom_mean(row_4.right, row_5.right);
    taps.inner = bloom_mean(row_1.inner_left, row_2.inner_left) + bloom_mean(row_1.inner_right, row_2.inner_right) +
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
    taps.left.top = bloom_mean(a.outer, b.outer);
    taps.centre.top = bloom_mean(a.centre, b.centre);
    taps.left.middle = bloom_mean(c.outer, d.outer);
    taps.centre.middle = bloom_mean(c.centre, d.centre);
    taps.right.top = from_beside(taps.centre.top);
    taps.right.middle = from_beside(taps.centre.middle);
    taps.left.bottom = from_below(taps.left.middle);
    taps.centre.bottom = from_below(taps.centre.middle);
    taps.right.bottom = from_below(taps.right.middle);
    vec3 side = bloom_part(b.last + c.last), lower = bloom_part(d.inner), corner = bloom_part(d.last);
    vec3 edge = corner + from_beside(corner);
    taps.inner = bloom_mean(b.inner, c.inner) + bloom_mean(side, from_beside(side)) +
                  bloom_mean(lower, from_below(lower)) + bloom_mean(edge, from_below(edge));
    return taps;
}

BloomTaps bloom_taps(Pixel pixel) {
    if (has_quads && input_is_twice) return bloom_by_quads(pixel);
    if (input_is_twice) return bloom_by_loads(pixel);
    return bloom_taps_of(0, pixel.texel, size(bloom_source));
}
