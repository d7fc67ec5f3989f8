// SPDX-License-Identifier: MIT
// The largest of a tile and its eight neighbours: nothing farther away reaches a pixel of the tile.
vec4 shade(Pixel pixel) {
    float largest = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            largest = max(largest, load_clamped(depth_of_field_from, pixel.texel + ivec2(x, y)).r);
    return vec4(largest);
}
