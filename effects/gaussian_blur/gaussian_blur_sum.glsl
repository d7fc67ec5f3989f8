// SPDX-License-Identifier: MIT
// What the passes along a line share. custom[0] = (weight of the texel itself, vectors that follow, direction in texels).
// Each further vector stands for four texels to either side, as two pairs: (f, w) of a pair says that its nearer texel
// weighs w (1 - f) and its farther one w f. `is_clean`: no texel is NaN or infinite.
#include "shared/sanitize.glsl"

vec3 gaussian_blur_clean(vec4 color, bool is_clean) {
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 gaussian_blur_vector(Pixel pixel, int i, bool is_clean);

// At full size. In the picture's own pixels the number is known from the radius.
int gaussian_blur_vectors() {
    GaussianBlur blur = gaussian_blur_parameters();
    return blur.reach == GaussianBlur_reach_pixels ? (blur.radius + 3) / 4 : int(custom[0].y);
}

vec3 gaussian_blur_sum(Pixel pixel, vec4 own, int vectors, bool is_clean) {
    vec3 sum = gaussian_blur_clean(own, is_clean) * custom[0].x;
    for (int i = 1; i <= vectors; ++i) sum += gaussian_blur_vector(pixel, i, is_clean);
    return sum;
}
