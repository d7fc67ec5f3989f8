// SPDX-License-Identifier: MIT
// The mean over the tile of the noise, of those pixels that lie in the surface here. The tile reaches from two pixels before
// this one to one after; the upsampling makes up for the half pixel. Beside it the surface's slope, and how much of the tile
// the mean is of.
#include "ssao_packed.glsl"
#include "ssao_surface.glsl"
#include "ssao_turned.glsl"

// Of the plane through a pixel with this normal.
vec2 ssao_plane_slope(ivec2 texel, float near, vec3 normal) {
    float toward = dot(normal.xy, vec2(texel) * custom[0].xy + custom[0].zw) - normal.z;
    return clamp(normal.xy * (custom[0].xy + custom[1].xy * near) / min(toward, -0.02), vec2(-0.999), vec2(0.999));
}

// That of the normal's plane, as far as the pixels before and after agree: between the two it is the plane's, so on thin
// parts, too; else that of the nearer one, as on flat parts whose normals are smoothed. Continuous in all three.
vec2 ssao_slope(vec2 before, vec2 after, vec2 plane) {
    vec2 a = 1.0 - before, b = after - 1.0;
    return min(max(plane, min(a, b)), max(a, b));
}

// How far normals count of pixels whose nearness is so much above that of the surface here, in the order of a gather. What
// lies before it, across a corner of a room, is as dark as the surface is there, and counts in full: without it the corner
// would lose its shade.
vec4 ssao_beside(vec4 above, ivec2 low, vec3 per_turn, float per_width) {
    vec4 turned = ssao_turned(load_clamped(ssao_normals, low + ivec2(0, 1)).xyz, load_clamped(ssao_normals, low + ivec2(1, 1)).xyz,
                              load_clamped(ssao_normals, low + ivec2(1, 0)).xyz, load_clamped(ssao_normals, low).xyz, per_turn);
    return max(turned, clamp(above * per_width, 0.0, 1.0));
}

// Order of a gather: (0,1), (1,1), (1,0), (0,0).
vec4 shade(Pixel pixel) {
    ivec2 at = pixel.texel;
    vec2 texel = 1.0 / vec2(pixel.size);
    vec2 low = (vec2(at) - 1.0) * texel, high = (vec2(at) + 1.0) * texel;
    vec4 packed_00 = gather_red(ssao_raw, low), packed_10 = gather_red(ssao_raw, vec2(high.x, low.y));
    vec4 packed_01 = gather_red(ssao_raw, vec2(low.x, high.y)), packed_11 = gather_red(ssao_raw, high);
    float own = ssao_near(packed_11.w), per_own = 1.0 / own;
    vec3 normal = load(ssao_normals, at).xyz, per_turn = normal * ssao_per_turn;
    vec2 before = vec2(ssao_near(packed_01.z), ssao_near(packed_10.x)), after = vec2(ssao_near(packed_11.z), ssao_near(packed_11.x));
    vec2 slope = ssao_slope(per_own * before, per_own * after, ssao_plane_slope(at, own, normal));
    float tolerance = ssao_tolerance(own, slope), per_width = 2.0 / ssao_width(own);
    vec4 expected = 1.0 + slope.x * vec4(0.0, 1.0, 1.0, 0.0) + slope.y * vec4(1.0, 1.0, 0.0, 0.0);
    vec4 above_00 = packed_00 * per_own - (expected - 2.0 * (slope.x + slope.y));
    vec4 above_10 = packed_10 * per_own - (expected - 2.0 * slope.y);
    vec4 above_01 = packed_01 * per_own - (expected - 2.0 * slope.x);
    vec4 above_11 = packed_11 * per_own - expected;
    vec4 weight_00 = ssao_weight(above_00, tolerance) * ssao_beside(above_00, at - 2, per_turn, per_width);
    vec4 weight_10 = ssao_weight(above_10, tolerance) * ssao_beside(above_10, at - ivec2(0, 2), per_turn, per_width);
    vec4 weight_01 = ssao_weight(above_01, tolerance) * ssao_beside(above_01, at - ivec2(2, 0), per_turn, per_width);
    vec4 weight_11 = ssao_weight(above_11, tolerance) * ssao_beside(above_11, at, per_turn, per_width);
    float sum = dot(ssao_visibility(packed_00), weight_00) + dot(ssao_visibility(packed_10), weight_10) +
                dot(ssao_visibility(packed_01), weight_01) + dot(ssao_visibility(packed_11), weight_11);
    // Its own weight is one.
    float covered = dot(weight_00 + weight_10 + weight_01 + weight_11, vec4(1.0));
    return vec4(ssao_with(own, sum / covered), ssao_pack_slope(slope, covered), 0.0, 0.0);
}
