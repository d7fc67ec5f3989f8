// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. The pyramid's alpha is 1; that of the image which stands in for it is 0.

vec4 bloom(vec4 color, Pixel pixel, Bloom parameters) {
    vec4 glow = sample_linear(bloom_pyramid, pixel.uv);
    bool is_additive = uint(parameters.mode) == 0u;
    // One expression for both modes: keep * color + add * glow.
    float add = is_additive ? parameters.intensity : min(parameters.intensity, 1.0) * glow.a;
    float keep = is_additive ? 1.0 : 1.0 - add;
    return vec4(color.rgb * keep + glow.rgb * add, color.a);
}
