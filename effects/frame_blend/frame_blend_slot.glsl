// SPDX-License-Identifier: MIT
// A slot of the ring: custom[0].x is 1 where it takes the present frame, 0 where it keeps what it has.
vec4 shade(Pixel pixel) {
    vec4 present = load(frame_blend_small, pixel.texel), kept = load(frame_blend_kept, pixel.texel);
    return custom[0].x != 0.0 ? present : kept;
}
