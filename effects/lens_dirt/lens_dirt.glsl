// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.

vec4 lens_dirt(vec4 color, Pixel pixel, LensDirt parameters) {
    vec3 light = sample_linear(lens_dirt_light, pixel.uv).rgb, dirt = sample_linear(lens_dirt_dirt, pixel.uv).rgb;
    return vec4(color.rgb + parameters.intensity * dirt * light, color.a);
}
