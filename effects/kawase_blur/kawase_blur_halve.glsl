// SPDX-License-Identifier: MIT
// Half the picture, after Marius Bjorge, "Bandwidth-efficient rendering" (2015): a tap in the middle of the output's pixel
// and four on its corners. With an offset of 1, five taps read 16 texels.
#include "kawase_blur_taps.glsl"

vec3 kawase_blur_half(vec2 uv, vec2 offset, bool is_clean) {
    return 0.5 * kawase_blur_tap(uv, is_clean) + 0.125 * kawase_blur_corner_sum(uv, offset, is_clean);
}

vec4 shade(Pixel pixel) {
    vec2 offset = 0.5 * custom[0].x / vec2(pixel.size);
    vec3 mean = kawase_blur_half(pixel.uv, offset, true);
    [[dont_flatten]] if (!is_finite(mean)) mean = kawase_blur_half(pixel.uv, offset, false);
    return vec4(clamp(mean, -65504.0, 65504.0), 1.0);
}
