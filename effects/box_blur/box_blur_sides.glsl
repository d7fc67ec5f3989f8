// SPDX-License-Identifier: MIT
// A sum, and the texels to both sides: a bilinear tap between two of them reads their mean.

vec3 box_blur_taps(Pixel pixel, float offset, bool is_clean) {
    vec2 offset_uv = custom[0].xy * offset / vec2(pixel.size);
    return box_blur_clean(sample_linear(box_blur_input, pixel.uv - offset_uv), is_clean) +
           box_blur_clean(sample_linear(box_blur_input, pixel.uv + offset_uv), is_clean);
}

vec3 box_blur_sides(Pixel pixel, int radius, vec3 sum, bool is_clean) {
    for (int i = 1; i < radius; i += 2) sum += 2.0 * box_blur_taps(pixel, float(i) + 0.5, is_clean);
    if ((radius & 1) == 1) sum += box_blur_texels(pixel, ivec2(custom[0].xy) * radius, is_clean);
    return sum;
}
