// SPDX-License-Identifier: MIT
#part small across down
// What the passes along a line share. custom[0] = (weight of the texel itself, vectors that follow, direction in texels).
// Each further vector stands for four texels to either side, as two pairs: (f, w) of a pair says that its nearer texel
// weighs w (1 - f) and its farther one w f. `is_clean`: no texel is NaN or infinite.
#include "shared/sanitize.glsl"

vec3 gaussian_blur_clean(vec4 color, bool is_clean) {
    return (is_clean ? color : sanitize(color)).rgb;
}

// One bilinear tap reads a pair at f between its texels.
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

#part small
// One direction of the blur of a smaller picture.

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    return vec4(gaussian_blur_sum(pixel, own, int(custom[0].y), true), own.a);
}

#part across
// The blur along the lines, in the picture's own domain. NaN counts as 0, infinity as 65504.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    // In lean kernels the radius is a literal, and the loop is unrolled.
    int vectors = gaussian_blur_vectors();
    vec3 sum = gaussian_blur_sum(pixel, own, vectors, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = gaussian_blur_sum(pixel, own, vectors, false);
    return vec4(clamp(sum, -65504.0, 65504.0), sanitize(own).a);
}

#part down
// The blur along the columns, of what gaussian_blur.glsl#across made.

vec4 shade(Pixel pixel) {
    vec4 own = load(gaussian_blur_input, pixel.texel);
    return vec4(gaussian_blur_sum(pixel, own, gaussian_blur_vectors(), true), own.a);
}

#part result
// The half-size picture at full size, with the pixel's own alpha.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    return vec4(sample_linear(gaussian_blur_small, pixel.uv).rgb,
                sanitize(load(gaussian_blur_picture, pixel.texel)).a);
}
