// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.

vec4 god_rays(vec4 color, Pixel pixel, GodRays parameters) {
    return vec4(color.rgb + sample_linear(god_rays_streaks, pixel.uv).rgb, color.a);
}
