// SPDX-License-Identifier: MIT
// The longest motion of a tile and its eight neighbours: nothing farther away reaches a pixel of the tile.
vec4 shade(Pixel pixel) {
    vec4 longest = vec4(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec4 motion = load_clamped(motion_blur_from, pixel.texel + ivec2(x, y));
            longest = motion.w > longest.w ? motion : longest;
        }
    return longest;
}
