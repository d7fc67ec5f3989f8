// SPDX-License-Identifier: MIT
#part corners halve double result
// What the passes share. `is_clean`: no texel is NaN or infinite.
#include "shared/sanitize.glsl"

vec3 kawase_blur_tap(vec2 uv, bool is_clean) {
    vec4 color = sample_linear(kawase_blur_input, uv);
    return (is_clean ? color : sanitize(color)).rgb;
}

// The sum of four taps on the corners of a rectangle.
vec3 kawase_blur_corner_sum(vec2 uv, vec2 offset, bool is_clean) {
    return kawase_blur_tap(uv - offset, is_clean) + kawase_blur_tap(uv + vec2(offset.x, -offset.y), is_clean) +
           kawase_blur_tap(uv + vec2(-offset.x, offset.y), is_clean) + kawase_blur_tap(uv + offset, is_clean);
}

#part corners
// A pass of Masaki Kawase, "Frame buffer postprocessing effects in DOUBLE-S.T.E.A.L" (2003): the mean of four taps on the
// corners custom[0].xy away. With an offset of 1 each lies between four texels and reads their mean.

vec4 shade(Pixel pixel) {
    vec3 sum = kawase_blur_corner_sum(pixel.uv, custom[0].xy, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = kawase_blur_corner_sum(pixel.uv, custom[0].xy, false);
    return vec4(clamp(sum * 0.25, -65504.0, 65504.0), sanitize(load(kawase_blur_input, pixel.texel)).a);
}

#part halve
// Half the picture, after Marius Bjorge, "Bandwidth-efficient rendering" (2015): a tap in the middle of the output's pixel
// and four on its corners. With an offset of 1, five taps read 16 texels.

vec3 kawase_blur_half(vec2 uv, vec2 offset, bool is_clean) {
    return 0.5 * kawase_blur_tap(uv, is_clean) + 0.125 * kawase_blur_corner_sum(uv, offset, is_clean);
}

vec4 shade(Pixel pixel) {
    vec2 offset = 0.5 * custom[0].x / vec2(pixel.size);
    vec3 mean = kawase_blur_half(pixel.uv, offset, true);
    [[dont_flatten]] if (!is_finite(mean)) mean = kawase_blur_half(pixel.uv, offset, false);
    return vec4(clamp(mean, -65504.0, 65504.0), 1.0);
}

#part double result
// Twice the picture, after Marius Bjorge, "Bandwidth-efficient rendering" (2015): taps on the corners of the smaller
// picture's texel, and half as much of its four neighbours.

vec3 kawase_blur_doubled(vec2 uv) {
    vec2 reach = custom[0].x / vec2(size(kawase_blur_input));
    vec3 neighbours = kawase_blur_tap(uv - vec2(reach.x, 0.0), true) + kawase_blur_tap(uv + vec2(reach.x, 0.0), true) +
                      kawase_blur_tap(uv - vec2(0.0, reach.y), true) + kawase_blur_tap(uv + vec2(0.0, reach.y), true);
    return (2.0 * kawase_blur_corner_sum(uv, 0.5 * reach, true) + neighbours) / 12.0;
}

#part double
vec4 shade(Pixel pixel) {
    return vec4(kawase_blur_doubled(pixel.uv), 1.0);
}

#part result
// The last doubling, with the pixel's own alpha.

vec4 shade(Pixel pixel) {
    return vec4(kawase_blur_doubled(pixel.uv), sanitize(load(kawase_blur_picture, pixel.texel)).a);
}
