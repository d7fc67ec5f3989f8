// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.

vec4 lens_flare(vec4 color, Pixel pixel, LensFlare parameters) {
    return vec4(color.rgb + parameters.intensity * sample_linear(lens_flare_flare, pixel.uv).rgb, color.a);
}
