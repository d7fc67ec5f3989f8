// SPDX-License-Identifier: MIT
// encoded -> encoded. The side image dither_tile holds triangular noise, another offset of one tile in each channel; in every
// frame dither_custom(0).x, an integer of 6 bits across and 6 down, shifts it.

const int dither_tile_size = 64;

vec4 dither(vec4 color, Pixel pixel, Dither parameters) {
    int offset = floatBitsToInt(dither_custom(0).x);
    vec3 noise = load(dither_tile, (pixel.texel + ivec2(offset, offset >> 6)) & (dither_tile_size - 1)).rgb;
    // Near black and white the noise narrows, so that nothing is clipped and the mean stays; outside there is none.
    vec3 width = max(min(vec3(0.5 * parameters.intensity), min(color.rgb, 1.0 - color.rgb)), vec3(0.0));
    return vec4(color.rgb + noise * width, color.a);
}
