// SPDX-License-Identifier: MIT
// Level i-1 to level i: the 13 taps of Jorge Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare"
// (2014). Inner taps 1, outer taps 2 source texels from the centre, which lies on a corner: each tap averages 2x2 texels.
#include "bloom_quad.glsl"

vec3 bloom_tap(vec2 uv) {
    return sample_linear(bloom_above, uv).rgb;
}

// The taps of all outputs form a grid of one texel's step with every second place empty, like the black squares of a
// chessboard. That is harmless while taps lie between texels. Where both sides of the source are odd, taps drift onto
// texels toward the middle, and every second texel would be lost. There the outer rows are 1 and the inner ones 1.5 texels
// from the centre: with these the sum over w cos(pi x) cos(pi y) of the taps is 0, as it is over w cos(pi x) and over
// w cos(pi y), so no pattern of that kind is left at any phase, and the filter is nearly as wide (variance 1.375, not 1.5).
vec3 bloom_by_taps(Pixel pixel) {
    // Half a texel of the output is one of the source, and a little more on odd sizes.
    ivec2 extent = size(bloom_above);
    bool is_odd = (extent.x & extent.y & 1) == 1;
    vec2 outer = (is_odd ? vec2(1.0, 0.5) : vec2(1.0)) / vec2(pixel.size);
    vec2 inner = (is_odd ? vec2(0.5, 0.75) : vec2(0.5)) / vec2(pixel.size);
    vec2 uv = pixel.uv;
    vec3 corners = bloom_tap(uv - outer) + bloom_tap(uv + outer * vec2(1, -1)) + bloom_tap(uv + outer * vec2(-1, 1)) +
                   bloom_tap(uv + outer);
    vec3 edges = bloom_tap(uv + outer * vec2(0, -1)) + bloom_tap(uv + outer * vec2(-1, 0)) +
                 bloom_tap(uv + outer * vec2(1, 0)) + bloom_tap(uv + outer * vec2(0, 1));
    vec3 middle = bloom_tap(uv - inner) + bloom_tap(uv + inner * vec2(1, -1)) + bloom_tap(uv + inner * vec2(-1, 1)) +
                  bloom_tap(uv + inner) + bloom_tap(uv);
    return corners * 0.03125 + edges * 0.0625 + middle * 0.125;
}

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
    if (is_software && input_is_twice) return vec4(bloom_by_loads(pixel), 1.0);
    return vec4(bloom_by_taps(pixel), 1.0);
}
