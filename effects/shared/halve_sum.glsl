// SPDX-License-Identifier: MIT
// The sum of shared/halve.glsl by four bilinear taps: two do along one axis what four texels would,
// between a and b at (2-f)/(3-2f) with weight (3-2f)/4, between c and d at f/(1+2f) with weight (1+2f)/4.
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
