// SPDX-License-Identifier: MIT
// encoded -> encoded. The side image dither_tile holds triangular noise, another offset of one tile in each channel.

const int dither_tile_size = 64;

// While time runs every frame shifts the tile by the next point of the R2 sequence (Martin Roberts, "The Unreasonable
// Effectiveness of Quasirandom Sequences", 2018), in 32-bit fixed point: the upper 6 bits are texels.
ivec2 dither_offset() {
    uint frame = frame_time > 0.0 ? frame_index : 0u;
    return ivec2((frame * uvec2(0xC13FA9A9u, 0x91E10DA6u)) >> 26u);
}

vec4 dither(vec4 color, Pixel pixel, Dither parameters) {
    vec3 noise = load(dither_tile, (pixel.texel + dither_offset()) & (dither_tile_size - 1)).rgb;
    // Near black and white the noise narrows, so that nothing is clipped and the mean stays; outside there is none.
    vec3 width = max(min(vec3(0.5 * parameters.intensity), min(color.rgb, 1.0 - color.rgb)), vec3(0.0));
    return vec4(color.rgb + noise * width, color.a);
}
