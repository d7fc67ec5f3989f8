// SPDX-License-Identifier: MIT
// A vector of gaussian_blur_sum.glsl: one bilinear tap reads a pair at f between its texels.

vec3 gaussian_blur_tap(vec2 uv, vec2 offset, bool is_clean) {
    return gaussian_blur_clean(sample_linear(gaussian_blur_input, uv - offset), is_clean) +
           gaussian_blur_clean(sample_linear(gaussian_blur_input, uv + offset), is_clean);
}

vec3 gaussian_blur_vector(Pixel pixel, int i, bool is_clean) {
    vec4 pairs = custom[i];
    int nearest = 4 * i - 3;
    vec2 direction = custom[0].zw / vec2(pixel.size);
    return gaussian_blur_tap(pixel.uv, direction * (float(nearest) + pairs.x), is_clean) * pairs.y +
           gaussian_blur_tap(pixel.uv, direction * (float(nearest + 2) + pairs.z), is_clean) * pairs.w;
}
