// SPDX-License-Identifier: MIT
// Level i+1 onto level i, a kernel of a pixel: the tent of bloom_texels.glsl, by 16 texels.

vec3 bloom_texel(int from, ivec2 texel) {
    return load(bloom_below, texel).rgb;
}

#include "bloom_texels.glsl"

vec3 bloom_row(ivec2 first, vec4 weights) {
    return bloom_weighed(load_clamped(bloom_below, first).rgb, load_clamped(bloom_below, first + ivec2(1, 0)).rgb,
                         load_clamped(bloom_below, first + ivec2(2, 0)).rgb,
                         load_clamped(bloom_below, first + ivec2(3, 0)).rgb, weights);
}

vec3 bloom_by_texels(Pixel pixel) {
    vec2 place = bloom_below_at(pixel.texel, size(bloom_below), pixel.size), low = floor(place), f = place - low;
    ivec2 first = ivec2(low) - 1;
    vec4 x = bloom_weights(f.x);
    return bloom_weighed(bloom_row(first, x), bloom_row(first + ivec2(0, 1), x), bloom_row(first + ivec2(0, 2), x),
                         bloom_row(first + ivec2(0, 3), x), bloom_weights(f.y));
}
