// SPDX-License-Identifier: MIT
// bloom_upsample.glsl by loads: sixteen at any fraction, and where the output is twice as large nine, of which the pixels
// of a quad share those in the middle.
#include "bloom_quad.glsl"

vec4 bloom_weights(float f) {
    return 0.25 * vec4(1.0 - f, 2.0 - f, 1.0 + f, f);
}

vec3 bloom_row(ivec2 a, vec4 weights) {
    return load_clamped(bloom_below, a).rgb * weights.x + load_clamped(bloom_below, a + ivec2(1, 0)).rgb * weights.y +
           load_clamped(bloom_below, a + ivec2(2, 0)).rgb * weights.z +
           load_clamped(bloom_below, a + ivec2(3, 0)).rgb * weights.w;
}

vec3 bloom_by_loads(vec2 b, vec2 f) {
    ivec2 a = ivec2(b) - 1;
    vec4 x = bloom_weights(f.x);
    vec4 y = bloom_weights(f.y);
    return bloom_row(a, x) * y.x + bloom_row(a + ivec2(0, 1), x) * y.y + bloom_row(a + ivec2(0, 2), x) * y.z +
           bloom_row(a + ivec2(0, 3), x) * y.w;
}

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
    if (has_quads && output_is_twice) return vec4(bloom_by_quads(pixel) * custom[1].x, 0.0);
    vec2 position = pixel.uv * custom[0].xy - 0.5;
    vec2 b = floor(position);
    return vec4(bloom_by_loads(b, position - b) * custom[1].x, 0.0);
}
