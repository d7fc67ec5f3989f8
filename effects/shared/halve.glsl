// SPDX-License-Identifier: MIT
// A picture of half the size, floored: the tent over four texels each way, centred on the output's own. Along one axis,
// where the centre lies at fraction f between b and c of the texels a b c d, their weights are
//     (1-f, 2-f, 1+f, f) / 4,
// (1 3 3 1) / 8 of an even side; at any fraction all texels of the picture count alike. NaN counts as 0, infinity as 65504.
#include "shared/sanitize.glsl"

// By four bilinear taps: two do along one axis what four texels would, between a and b at (2-f)/(3-2f) with weight
// (3-2f)/4, between c and d at f/(1+2f) with weight (1+2f)/4.
vec3 halve_tap(vec2 uv, bool is_clean) {
    vec4 color = sample_linear(halve_input, uv);
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 halve_sum(vec2 b, vec2 f, bool is_clean) {
    vec2 extent = vec2(size(halve_input));
    vec2 near = (b - 0.5 + (2.0 - f) / (3.0 - 2.0 * f)) / extent;
    vec2 far = (b + 1.5 + f / (1.0 + 2.0 * f)) / extent;
    vec2 far_weight = 0.25 + 0.5 * f;
    vec2 near_weight = 1.0 - far_weight;
    vec3 top = halve_tap(near, is_clean) * near_weight.x + halve_tap(vec2(far.x, near.y), is_clean) * far_weight.x;
    vec3 bottom = halve_tap(vec2(near.x, far.y), is_clean) * near_weight.x + halve_tap(far, is_clean) * far_weight.x;
    return top * near_weight.y + bottom * far_weight.y;
}

vec4 shade(Pixel pixel) {
    vec2 position = pixel.uv * vec2(size(halve_input)) - 0.5;
    vec2 b = floor(position);
    vec2 f = position - b;
    vec3 sum = halve_sum(b, f, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = halve_sum(b, f, false);
    return vec4(clamp(sum, -65504.0, 65504.0), 1.0);
}
