// SPDX-License-Identifier: MIT
// Any domain. What earlier frames do not weigh, the present one does: all of it after a cut.
vec4 frame_blend(vec4 color, Pixel pixel, FrameBlend parameters) {
    vec4 past = sample_linear(frame_blend_past, pixel.uv);
    return vec4(color.rgb * (1.0 - past.a) + past.rgb, color.a);
}
