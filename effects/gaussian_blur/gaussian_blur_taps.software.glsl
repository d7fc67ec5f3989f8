// SPDX-License-Identifier: MIT
// A vector of gaussian_blur_sum.glsl by its texels.

vec3 gaussian_blur_texel(ivec2 texel, ivec2 offset, bool is_clean) {
    return gaussian_blur_clean(load_clamped(gaussian_blur_input, texel - offset), is_clean) +
           gaussian_blur_clean(load_clamped(gaussian_blur_input, texel + offset), is_clean);
}

vec3 gaussian_blur_vector(Pixel pixel, int i, bool is_clean) {
    vec4 pairs = custom[i];
    int nearest = 4 * i - 3;
    ivec2 direction = ivec2(custom[0].zw);
    vec2 far_weights = pairs.xz * pairs.yw;
    vec2 near_weights = pairs.yw - far_weights;
    return gaussian_blur_texel(pixel.texel, direction * nearest, is_clean) * near_weights.x +
           gaussian_blur_texel(pixel.texel, direction * (nearest + 1), is_clean) * far_weights.x +
           gaussian_blur_texel(pixel.texel, direction * (nearest + 2), is_clean) * near_weights.y +
           gaussian_blur_texel(pixel.texel, direction * (nearest + 3), is_clean) * far_weights.y;
}
