// SPDX-License-Identifier: MIT
// The 13 taps of Jorge Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (2014), of a level half
// the size: a grid of 3x3 outer ones with steps of 2 source texels, and 2x2 inner ones between them. They stand in columns,
// of which pixels side by side share some. Places are counted in half texels of the output. Who includes this defines
// bloom_tap(), a tap of what it calls `from`.
//
// The centre lies on a corner of texels, so each tap averages 2x2 of them. The taps of all outputs form a grid of one
// texel's step with every second place empty, like the black squares of a chessboard. That is harmless while taps lie
// between texels. Where both sides of a level are odd, taps drift onto texels toward the middle, and every second texel
// would be lost. There the outer rows are 1 and the inner ones 1.5 texels from the centre: with these the sum over
// w cos(pi x) cos(pi y) of the taps is 0, as it is over w cos(pi x) and over w cos(pi y), so no pattern of that kind is left
// at any phase, and the filter is nearly as wide (variance 1.375, not 1.5).

vec3 bloom_tap(int from, vec2 place);

struct BloomColumn {
    vec3 top, middle, bottom;
};
struct BloomTaps {
    BloomColumn left, centre, right;
    vec3 inner;  // the sum of the inner taps
};

// How far outer and inner rows are from the centre.
const vec2 bloom_rows_between = vec2(2.0, 1.0);
vec2 bloom_rows(ivec2 above) {
    return mix(bloom_rows_between, vec2(1.0, 1.5), float(above.x & above.y & 1));
}

BloomColumn bloom_outer(int from, vec2 place, vec2 rows) {
    return BloomColumn(bloom_tap(from, place - vec2(0.0, rows.x)), bloom_tap(from, place),
                       bloom_tap(from, place + vec2(0.0, rows.x)));
}

vec3 bloom_inner(int from, vec2 place, vec2 rows) {
    return bloom_tap(from, place - vec2(0.0, rows.y)) + bloom_tap(from, place + vec2(0.0, rows.y));
}

BloomTaps bloom_taps_of(int from, ivec2 texel, vec2 rows) {
    vec2 place = vec2(2 * texel + 1), right = vec2(1.0, 0.0);
    return BloomTaps(bloom_outer(from, place - 2.0 * right, rows), bloom_outer(from, place, rows),
                     bloom_outer(from, place + 2.0 * right, rows),
                     bloom_inner(from, place - right, rows) + bloom_inner(from, place + right, rows));
}

// Taps of a pixel and of the one to its right, which share two columns of outer taps.
BloomTaps[2] bloom_taps_of_pair(int from, ivec2 texel, vec2 rows) {
    vec2 place = vec2(2 * texel + 1);
    BloomColumn outer[4];
    vec3 inner[3];
    for (int i = 0; i < 4; ++i) outer[i] = bloom_outer(from, place + vec2(2 * i - 2, 0), rows);
    for (int i = 0; i < 3; ++i) inner[i] = bloom_inner(from, place + vec2(2 * i - 1, 0), rows);
    return BloomTaps[2](BloomTaps(outer[0], outer[1], outer[2], inner[0] + inner[1]),
                        BloomTaps(outer[1], outer[2], outer[3], inner[1] + inner[2]));
}

// Five overlapping boxes of four taps each, with weights 0.5 and 4 x 0.125.
vec3 bloom_mean_of(BloomTaps taps) {
    vec3 corners = taps.left.top + taps.right.top + taps.left.bottom + taps.right.bottom;
    vec3 edges = taps.centre.top + taps.left.middle + taps.right.middle + taps.centre.bottom;
    return corners * 0.03125 + edges * 0.0625 + (taps.inner + taps.centre.middle) * 0.125;
}
