// SPDX-License-Identifier: MIT
// The mean along one direction, custom[0].xy in texels. In the picture's own domain; NaN counts as 0, infinity as 65504.
// A bilinear tap between two texels reads their mean.
#include "shared/finite.glsl"
#include "shared/sanitize.glsl"

vec3 box_blur_clean(vec4 color, bool is_clean) {
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 box_blur_texels(Pixel pixel, ivec2 offset, bool is_clean) {
    return box_blur_clean(load_clamped(box_blur_input, pixel.texel - offset), is_clean) +
           box_blur_clean(load_clamped(box_blur_input, pixel.texel + offset), is_clean);
}

vec3 box_blur_taps(Pixel pixel, float offset, bool is_clean) {
    vec2 offset_uv = custom[0].xy * offset / vec2(pixel.size);
    return box_blur_clean(sample_linear(box_blur_input, pixel.uv - offset_uv), is_clean) +
           box_blur_clean(sample_linear(box_blur_input, pixel.uv + offset_uv), is_clean);
}

vec3 box_blur_mean(Pixel pixel, vec4 own, bool is_clean) {
    int radius = box_blur_parameters().radius;
    ivec2 direction = ivec2(custom[0].xy);
    vec3 sum = box_blur_clean(own, is_clean);
    if (is_software) {
        for (int i = 1; i <= radius; ++i) sum += box_blur_texels(pixel, direction * i, is_clean);
    } else {
        for (int i = 1; i < radius; i += 2) sum += 2.0 * box_blur_taps(pixel, float(i) + 0.5, is_clean);
        if ((radius & 1) == 1) sum += box_blur_texels(pixel, direction * radius, is_clean);
    }
    return sum / float(2 * radius + 1);
}

vec4 shade(Pixel pixel) {
    vec4 own = load(box_blur_input, pixel.texel);
    vec3 mean = box_blur_mean(pixel, own, true);
    [[dont_flatten]] if (!is_finite(mean)) mean = box_blur_mean(pixel, own, false);
    return vec4(clamp(mean, -65504.0, 65504.0), sanitize(own).a);
}
