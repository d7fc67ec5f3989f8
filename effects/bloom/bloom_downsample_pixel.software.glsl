// SPDX-License-Identifier: MIT
// bloom_downsample_pixel.glsl by the 6x6 texels under the taps, where all lie on corners, which the pixels of a quad share.
#include "bloom_quad.glsl"
#include "bloom_taps.glsl"

struct BloomRow {
    vec3 box;   // weights 0 1 1 1 1 0
    vec3 wide;  // weights 1 1 2 2 1 1
};

BloomRow bloom_row(ivec2 first) {
    vec3 outer = load_clamped(bloom_above, first).rgb + load_clamped(bloom_above, first + ivec2(5, 0)).rgb;
    vec3 inner = load_clamped(bloom_above, first + ivec2(1, 0)).rgb + load_clamped(bloom_above, first + ivec2(4, 0)).rgb;
    vec3 centre = load_clamped(bloom_above, first + ivec2(2, 0)).rgb + load_clamped(bloom_above, first + ivec2(3, 0)).rgb;
    vec3 box = inner + centre;
    return BloomRow(box, box + outer + centre);
}

// The texels under the taps, where all taps lie on corners. Along one axis they are 6. The inner taps are a 4x4 box: half
// the weight, b x b / 2 with b = (0 1 1 1 1 0) / 4. The outer ones and the centre make four boxes that share their sides:
// along one axis the pairs count 1 2 1, so they are w x w / 2 with w = (1 1 2 2 1 1) / 8.
vec3 bloom_by_loads(Pixel pixel) {
    ivec2 first = pixel.texel * 2 - 2;
    BloomRow row_0 = bloom_row(first);
    BloomRow row_1 = bloom_row(first + ivec2(0, 1));
    BloomRow row_2 = bloom_row(first + ivec2(0, 2));
    BloomRow row_3 = bloom_row(first + ivec2(0, 3));
    BloomRow row_4 = bloom_row(first + ivec2(0, 4));
    BloomRow row_5 = bloom_row(first + ivec2(0, 5));
    vec3 box = row_1.box + row_2.box + row_3.box + row_4.box;
    vec3 wide = row_0.wide + row_1.wide + row_4.wide + row_5.wide + 2.0 * (row_2.wide + row_3.wide);
    return box * (0.5 / 16.0) + wide * (0.5 / 64.0);
}

struct BloomQuarter {
    vec3 box, wide;              // a row of the own quarter, the first four of b and w
    vec3 other_box, other_wide;  // for the pixel beside, the last two, from the middle out
};

BloomQuarter bloom_quarter(ivec2 first, ivec2 inward, int row) {
    vec3 outer = load_clamped(bloom_above, first + inward * ivec2(0, row)).rgb;
    vec3 second = load_clamped(bloom_above, first + inward * ivec2(1, row)).rgb;
    vec3 third = load_clamped(bloom_above, first + inward * ivec2(2, row)).rgb;
    vec3 inner = load_clamped(bloom_above, first + inward * ivec2(3, row)).rgb;
    vec3 pair = third + inner;
    return BloomQuarter(second + pair, outer + second + 2.0 * pair, inner, pair);
}

vec3 bloom_by_quads(Pixel pixel) {
    ivec2 first = bloom_first(pixel), inward = bloom_inward(pixel);
    BloomQuarter a = bloom_quarter(first, inward, 0), b = bloom_quarter(first, inward, 1);
    BloomQuarter c = bloom_quarter(first, inward, 2), d = bloom_quarter(first, inward, 3);
    const float box = 0.5 / 16.0, wide = 0.5 / 64.0;
    return bloom_sum((b.box + c.box + d.box) * box + (a.wide + b.wide + 2.0 * (c.wide + d.wide)) * wide,
                     (b.other_box + c.other_box + d.other_box) * box +
                         (a.other_wide + b.other_wide + 2.0 * (c.other_wide + d.other_wide)) * wide,
                     d.box * box + (c.wide + d.wide) * wide, d.other_box * box + (c.other_wide + d.other_wide) * wide);
}

vec4 shade(Pixel pixel) {
    if (has_quads && input_is_twice) return vec4(bloom_by_quads(pixel), 1.0);
    if (input_is_twice) return vec4(bloom_by_loads(pixel), 1.0);
    return vec4(bloom_mean_of(bloom_taps_of(0, pixel.texel, size(bloom_above))), 1.0);
}
