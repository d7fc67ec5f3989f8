// SPDX-License-Identifier: MIT
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
