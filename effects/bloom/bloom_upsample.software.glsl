// SPDX-License-Identifier: MIT
// bloom_upsample.glsl by 9 texels, which the pixels of a quad share, where the level is twice the one below.
#include "bloom_quad.glsl"
#include "bloom_upsample_texels.glsl"

// f is 0.75 in the first pixel of a quad and 0.25 in the second, about the same texel in the middle: from the border to
// it the weights are (1, 5, 7) / 16, and 3 / 16 of the neighbour's second texel.
struct BloomQuarter {
    vec3 own, other;
};

BloomQuarter bloom_quarter(ivec2 first, ivec2 inward, int row) {
    vec3 second = load_clamped(bloom_below, first + inward * ivec2(1, row)).rgb;
    return BloomQuarter(load_clamped(bloom_below, first + inward * ivec2(0, row)).rgb * 0.0625 + second * 0.3125 +
                            load_clamped(bloom_below, first + inward * ivec2(2, row)).rgb * 0.4375,
                        second * 0.1875);
}

vec3 bloom_by_quads(Pixel pixel) {
    ivec2 inward = bloom_inward(pixel), first = (pixel.texel >> 1) - 2 * inward;
    BloomQuarter a = bloom_quarter(first, inward, 0), b = bloom_quarter(first, inward, 1);
    BloomQuarter c = bloom_quarter(first, inward, 2);
    return bloom_sum(a.own * 0.0625 + b.own * 0.3125 + c.own * 0.4375,
                     a.other * 0.0625 + b.other * 0.3125 + c.other * 0.4375, b.own * 0.1875, b.other * 0.1875);
}

vec4 shade(Pixel pixel) {
    vec3 glow = has_quads && output_is_twice ? bloom_by_quads(pixel) : bloom_by_texels(pixel);
    return vec4(glow * custom[0].x, 0.0);
}
