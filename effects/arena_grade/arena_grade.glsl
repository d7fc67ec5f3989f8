// SPDX-License-Identifier: MIT
// scene_linear -> display_linear, up to 2. The table is 16 to a side, a strip of slices: the place of a texel's middle is
// c * 0.9375 + 0.03125 of the side. Trilinear in single precision, where a sampler of 8 bits may round on the way.
#include "shared/sanitize.glsl"

vec3 arena_grade_entry(ivec3 at) {
    return load(arena_grade_table, ivec2(at.r + 16 * at.b, at.g)).rgb;
}

vec3 arena_grade_lookup(vec3 color) {
    vec3 place = clamp((color * 0.9375 + 0.03125) * 16.0 - 0.5, 0.0, 15.0);
    ivec3 low = min(ivec3(place), 14);
    vec3 f = place - vec3(low);
    vec3 rows[4];
    for (int i = 0; i < 4; ++i) {
        ivec3 start = low + ivec3(0, i & 1, i >> 1);
        rows[i] = mix(arena_grade_entry(start), arena_grade_entry(start + ivec3(1, 0, 0)), f.r);
    }
    return mix(mix(rows[0], rows[1], f.g), mix(rows[2], rows[3], f.g), f.b);
}

vec4 arena_grade(vec4 color, Pixel pixel, ArenaGrade parameters) {
    color = sanitize(color);
    vec3 srgb = pow(max(color.rgb, vec3(0.0)), vec3(0.4545449912548065));
    vec3 graded = pow(((arena_grade_lookup(srgb) - srgb) * 0.99961 + srgb) * 1.3703, vec3(2.2));
    float alpha = clamp(color.a, 0.0, 1.0);
    // At the ends the bits of either: a mask that is 0 leaves the picture as it is.
    return vec4(alpha == 0.0 ? color.rgb : alpha == 1.0 ? graded : mix(color.rgb, graded, alpha), alpha);
}
