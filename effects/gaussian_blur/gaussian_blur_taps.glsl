// SPDX-License-Identifier: MIT
// What the passes along a line share. custom[0] = (weight of the texel itself, vectors that follow, direction in texels).
// Each further vector stands for four texels to either side, as two pairs: (f, w) of a pair says that its nearer texel
// weighs w (1 - f) and its farther one w f, which one bilinear tap reads at f between them. `is_clean`: no texel is NaN
// or infinite.
#include "shared/sanitize.glsl"

vec3 gaussian_blur_clean(vec4 color, bool is_clean) {
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 gaussian_blur_tap(vec2 uv, vec2 offset, bool is_clean) {
    return gaussian_blur_clean(sample_linear(gaussian_blur_input, uv - offset), is_clean) +
           gaussian_blur_clean(sample_linear(gaussian_blur_input, uv + offset), is_clean);
}

vec3 gaussian_blur_texel(ivec2 texel, ivec2 offset, bool is_clean) {
    return gaussian_blur_clean(load_clamped(gaussian_blur_input, texel - offset), is_clean) +
           gaussian_blur_clean(load_clamped(gaussian_blur_input, texel + offset), is_clean);
}

vec3 gaussian_blur_vector(Pixel pixel, int i, bool is_clean) {
    vec4 pairs = custom[i];
    int nearest = 4 * i - 3;
    if (is_software) {
        ivec2 direction = ivec2(custom[0].zw);
        vec2 far_weights = pairs.xz * pairs.yw;
        vec2 near_weights = pairs.yw - far_weights;
        return gaussian_blur_texel(pixel.texel, direction * nearest, is_clean) * near_weights.x +
               gaussian_blur_texel(pixel.texel, direction * (nearest + 1), is_clean) * far_weights.x +
               gaussian_blur_texel(pixel.texel, direction * (nearest + 2), is_clean) * near_weights.y +
               gaussian_blur_texel(pixel.texel, direction * (nearest + 3), is_clean) * far_weights.y;
    }
    vec2 direction = custom[0].zw / vec2(pixel.size);
    return gaussian_blur_tap(pixel.uv, direction * (float(nearest) + pairs.x), is_clean) * pairs.y +
           gaussian_blur_tap(pixel.uv, direction * (float(nearest + 2) + pairs.z), is_clean) * pairs.w;
}

vec3 gaussian_blur_sum(Pixel pixel, vec4 own, int vectors, bool is_clean) {
    vec3 sum = gaussian_blur_clean(own, is_clean) * custom[0].x;
    for (int i = 1; i <= vectors; ++i) sum += gaussian_blur_vector(pixel, i, is_clean);
    return sum;
}
