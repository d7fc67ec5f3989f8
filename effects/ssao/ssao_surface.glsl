// SPDX-License-Identifier: MIT
// Whether pixels lie in one surface, by their nearness: one over the planar distance, which is linear across the picture
// of a plane; and by their normals, which tell the sides of an edge apart that meet in it. Slopes are shares of the
// nearness here. custom[0] and [1]: the ray through a texel, xy * texel + zw, by the distance and beside it.

// Of the nearness: a texel's width, or what is left of it beside the bits that the visibility takes.
float ssao_width(float near) { return max(custom[0].x + custom[1].x * near, 3e-4); }

// One over what a surface may bend: a texel's width and four tenths of its slope, as round parts do toward their
// outlines; at twice that it is another one.
float ssao_tolerance(float near, vec2 slope) {
    return 1.0 / (ssao_width(near) + 0.4 * (abs(slope.x) + abs(slope.y)));
}

vec4 ssao_weight(vec4 unlike, float tolerance) { return clamp(2.0 - abs(unlike) * tolerance, 0.0, 1.0); }
