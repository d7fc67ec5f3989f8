// SPDX-License-Identifier: MIT
// What is made of single texels, of an image or of a tile in shared memory: bilinear taps, and the tent that brings a level
// onto the one above. Who includes this defines bloom_texel().
//
// The tent is 3x3, (1 2 1 / 2 4 2 / 1 2 1) / 16, of bilinear taps one source texel apart. Along one axis, three such taps at
// fraction f between the texels a b c d weigh them by
//     (1-f)(1,2,1,0)/4 + f(0,1,2,1)/4 = (1-f, 2-f, 1+f, f)/4.

vec3 bloom_texel(int from, ivec2 texel);

// A tap of the level above, at a place in half texels of `own`.
vec3 bloom_between(int from, vec2 place, ivec2 above, ivec2 own) {
    vec2 position = place * (0.5 * vec2(above) / vec2(own)) - 0.5, low = floor(position), f = position - low;
    ivec2 first = clamp(ivec2(low), ivec2(0), above - 1), second = clamp(ivec2(low) + 1, ivec2(0), above - 1);
    vec3 a = bloom_texel(from, first), b = bloom_texel(from, ivec2(second.x, first.y));
    vec3 c = bloom_texel(from, ivec2(first.x, second.y)), d = bloom_texel(from, second);
    vec3 upper = a + (b - a) * f.x, lower = c + (d - c) * f.x;
    return upper + (lower - upper) * f.y;
}

// The middle of a texel of `own`, counted in texels of the level below it.
vec2 bloom_below_at(ivec2 texel, ivec2 below, ivec2 own) {
    return (vec2(texel) + 0.5) * (vec2(below) / vec2(own)) - 0.5;
}

// `tent` is the share of it: at 0 there is one tap, (0, 1-f, f, 0).
vec4 bloom_weights(float f, float tent) {
    float aside = 0.25 * tent;
    return vec4(0.0, 1.0 - f, f, 0.0) + aside * vec4(1.0 - f, 3.0 * f - 2.0, 1.0 - 3.0 * f, f);
}

vec3 bloom_weighed(vec3 a, vec3 b, vec3 c, vec3 d, vec4 weights) {
    return a * weights.x + b * weights.y + c * weights.z + d * weights.w;
}
