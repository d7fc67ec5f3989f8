// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. bloom_custom(0).x: the weight of the glow, 0 where there is none.

vec4 bloom(vec4 color, Pixel pixel, Bloom parameters) {
    vec3 glow = sample_linear(bloom_pyramid, pixel.uv).rgb;
    float add = bloom_custom(0).x;
    float keep = parameters.mode == Bloom_mode_additive ? 1.0 : 1.0 - add;
    return vec4(color.rgb * keep + glow * add, color.a);
}
