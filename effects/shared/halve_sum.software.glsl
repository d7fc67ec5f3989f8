// SPDX-License-Identifier: MIT
// The sum of shared/halve.glsl by its sixteen texels.
vec4 halve_weights(float f) {
    return 0.25 * vec4(1.0 - f, 2.0 - f, 1.0 + f, f);
}

vec3 halve_texel(ivec2 texel, bool is_clean) {
    vec4 color = load_clamped(halve_input, texel);
    return (is_clean ? color : sanitize(color)).rgb;
}

vec3 halve_row(ivec2 a, vec4 weights, bool is_clean) {
    return halve_texel(a, is_clean) * weights.x + halve_texel(a + ivec2(1, 0), is_clean) * weights.y +
           halve_texel(a + ivec2(2, 0), is_clean) * weights.z + halve_texel(a + ivec2(3, 0), is_clean) * weights.w;
}

vec3 halve_sum(vec2 b, vec2 f, bool is_clean) {
    ivec2 a = ivec2(b) - 1;
    vec4 x = halve_weights(f.x);
    vec4 y = halve_weights(f.y);
    return halve_row(a, x, is_clean) * y.x + halve_row(a + ivec2(0, 1), x, is_clean) * y.y +
           halve_row(a + ivec2(0, 2), x, is_clean) * y.z + halve_row(a + ivec2(0, 3), x, is_clean) * y.w;
}
