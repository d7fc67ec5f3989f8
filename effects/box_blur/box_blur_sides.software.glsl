// SPDX-License-Identifier: MIT
// A sum, and the texels to both sides.

vec3 box_blur_sides(Pixel pixel, int radius, vec3 sum, bool is_clean) {
    ivec2 direction = ivec2(custom[0].xy);
    for (int i = 1; i <= radius; ++i) sum += box_blur_texels(pixel, direction * i, is_clean);
    return sum;
}
