// SPDX-License-Identifier: MIT
// Twice the picture, after Marius Bjorge, "Bandwidth-efficient rendering" (2015): taps on the corners of the smaller
// picture's texel, and half as much of its four neighbours. Behind kawase_blur_taps.glsl.

vec3 kawase_blur_doubled(vec2 uv) {
    vec2 reach = custom[0].x / vec2(size(kawase_blur_input));
    vec3 neighbours = kawase_blur_tap(uv - vec2(reach.x, 0.0), true) + kawase_blur_tap(uv + vec2(reach.x, 0.0), true) +
                      kawase_blur_tap(uv - vec2(0.0, reach.y), true) + kawase_blur_tap(uv + vec2(0.0, reach.y), true);
    return (2.0 * kawase_blur_corner_sum(uv, 0.5 * reach, true) + neighbours) / 12.0;
}
