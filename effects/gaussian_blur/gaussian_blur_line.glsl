// SPDX-License-Identifier: MIT
// One direction of the blur, in the picture's own domain. custom[0] = (weight of the pixel itself, vectors that follow,
// direction in texels), custom[1 ...] = (offset, weight, offset, weight): two bilinear taps to each side, each standing
// for two texels.
#include "shared/sanitize.glsl"

vec3 gaussian_blur_pair(vec2 uv, vec2 offset) {
    return sanitize(sample_linear(gaussian_blur_input, uv - offset)).rgb +
           sanitize(sample_linear(gaussian_blur_input, uv + offset)).rgb;
}

vec4 shade(Pixel pixel) {
    vec4 own = sanitize(load(gaussian_blur_input, pixel.texel));
    vec2 step_uv = custom[0].zw / vec2(pixel.size);
    vec3 sum = own.rgb * custom[0].x;
    int last = int(custom[0].y);
    for (int i = 1; i <= last; ++i) {
        vec4 taps = custom[i];
        sum += gaussian_blur_pair(pixel.uv, step_uv * taps.x) * taps.y;
        sum += gaussian_blur_pair(pixel.uv, step_uv * taps.z) * taps.w;
    }
    return vec4(sum, own.a);
}
