// SPDX-License-Identifier: MIT
// All slots by their weights, custom[0] and custom[1]; alpha is the weight of those that hold a frame.
vec4 shade(Pixel pixel) {
    return load(frame_blend_0, pixel.texel) * custom[0].x + load(frame_blend_1, pixel.texel) * custom[0].y +
           load(frame_blend_2, pixel.texel) * custom[0].z + load(frame_blend_3, pixel.texel) * custom[0].w +
           load(frame_blend_4, pixel.texel) * custom[1].x + load(frame_blend_5, pixel.texel) * custom[1].y +
           load(frame_blend_6, pixel.texel) * custom[1].z + load(frame_blend_7, pixel.texel) * custom[1].w;
}
