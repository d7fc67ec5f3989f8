// SPDX-License-Identifier: MIT
// A pass of Masaki Kawase, "Frame buffer postprocessing effects in DOUBLE-S.T.E.A.L" (2003): the mean of four taps on the
// corners custom[0].xy away. With an offset of 1 each lies between four texels and reads their mean.
#include "kawase_blur_taps.glsl"

vec4 shade(Pixel pixel) {
    vec3 sum = kawase_blur_corner_sum(pixel.uv, custom[0].xy, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = kawase_blur_corner_sum(pixel.uv, custom[0].xy, false);
    return vec4(clamp(sum * 0.25, -65504.0, 65504.0), sanitize(load(kawase_blur_input, pixel.texel)).a);
}
