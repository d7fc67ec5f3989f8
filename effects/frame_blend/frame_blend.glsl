// SPDX-License-Identifier: MIT
#part slot
// A slot of the ring: custom[0].x is 1 where it takes the present frame, 0 where it keeps what it has.
vec4 shade(Pixel pixel) {
    vec4 present = load(frame_blend_small, pixel.texel), kept = load(frame_blend_kept, pixel.texel);
    return custom[0].x != 0.0 ? present : kept;
}

#part reduce
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

#part sum
// All slots by their weights, custom[0] and custom[1]; alpha is the weight of those that hold a frame.
vec4 shade(Pixel pixel) {
    return load(frame_blend_0, pixel.texel) * custom[0].x + load(frame_blend_1, pixel.texel) * custom[0].y +
           load(frame_blend_2, pixel.texel) * custom[0].z + load(frame_blend_3, pixel.texel) * custom[0].w +
           load(frame_blend_4, pixel.texel) * custom[1].x + load(frame_blend_5, pixel.texel) * custom[1].y +
           load(frame_blend_6, pixel.texel) * custom[1].z + load(frame_blend_7, pixel.texel) * custom[1].w;
}

#part end
// Any domain. What earlier frames do not weigh, the present one does: all of it after a cut.
vec4 frame_blend(vec4 color, Pixel pixel, FrameBlend parameters) {
    vec4 past = sample_linear(frame_blend_past, pixel.uv);
    return vec4(color.rgb * (1.0 - past.a) + past.rgb, color.a);
}
