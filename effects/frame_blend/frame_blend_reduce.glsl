// SPDX-License-Identifier: MIT
// The mean of the texels under one of a small picture. Alpha 1 tells a frame from what a cut has left: nothing.
#include "shared/sanitize.glsl"

vec4 frame_blend_tap(vec2 uv) { return sanitize(sample_linear(frame_blend_picture, uv)); }

vec4 shade(Pixel pixel) {
    // A quarter of the texel's side.
    vec2 quarter = 0.25 / vec2(pixel.size);
    vec4 sum = frame_blend_tap(pixel.uv - quarter) + frame_blend_tap(pixel.uv + quarter) +
               frame_blend_tap(pixel.uv + vec2(quarter.x, -quarter.y)) +
               frame_blend_tap(pixel.uv + vec2(-quarter.x, quarter.y));
    return vec4(sum.rgb * 0.25, 1.0);
}
