// SPDX-License-Identifier: MIT
// The mean along one direction, custom[0].xy in texels; custom[0].zw: a radius in parts of the height, as whole texels and a
// share of the next. In the picture's own domain; NaN counts as 0, infinity as 65504.
#include "shared/sanitize.glsl"

vec3 box_blur_clean(vec4 color, bool is_clean) {
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 box_blur_texels(Pixel pixel, ivec2 offset, bool is_clean) {
    return box_blur_clean(load_clamped(box_blur_input, pixel.texel - offset), is_clean) +
           box_blur_clean(load_clamped(box_blur_input, pixel.texel + offset), is_clean);
}

// A bilinear tap between two texels reads their mean.
vec3 box_blur_taps(Pixel pixel, float offset) {
    vec2 offset_uv = custom[0].xy * offset / vec2(pixel.size);
    return sample_linear(box_blur_input, pixel.uv - offset_uv).rgb +
           sample_linear(box_blur_input, pixel.uv + offset_uv).rgb;
}

// A tap also looks at pixels that count nothing, which may be NaN: where one is near, all are loaded.
vec3 box_blur_sides(Pixel pixel, int radius, vec3 sum, bool is_clean) {
    if (!is_clean) {
        for (int i = 1; i <= radius; ++i) sum += box_blur_texels(pixel, ivec2(custom[0].xy) * i, is_clean);
        return sum;
    }
    for (int i = 1; i < radius; i += 2) sum += 2.0 * box_blur_taps(pixel, float(i) + 0.5);
    if ((radius & 1) == 1) sum += box_blur_texels(pixel, ivec2(custom[0].xy) * radius, is_clean);
    return sum;
}

vec3 box_blur_mean(Pixel pixel, vec4 own, bool is_clean) {
    BoxBlur blur = box_blur_parameters();
    bool is_whole = blur.reach == BoxBlur_reach_pixels;
    int radius = is_whole ? blur.radius : int(custom[0].z);
    vec3 sum = box_blur_sides(pixel, radius, box_blur_clean(own, is_clean), is_clean);
    if (is_whole) return sum / float(2 * radius + 1);
    sum += custom[0].w * box_blur_texels(pixel, ivec2(custom[0].xy) * (radius + 1), is_clean);
    return sum / (2.0 * (custom[0].z + custom[0].w) + 1.0);
}

vec4 shade(Pixel pixel) {
    vec4 own = load(box_blur_input, pixel.texel);
    vec3 mean = box_blur_mean(pixel, own, true);
    [[dont_flatten]] if (!is_finite(mean)) mean = box_blur_mean(pixel, own, false);
    return vec4(clamp(mean, -65504.0, 65504.0), sanitize(own).a);
}
