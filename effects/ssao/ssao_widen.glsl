// SPDX-License-Identifier: MIT
// A tent over three by three tiles (after Holger Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform", 2010), of those
// pixels that lie in the surface here. Of two that lie opposite each other both count alike: what rises steadily, toward a
// corner of a room, stays as it is up to the corner.
#include "ssao_packed.glsl"
#include "ssao_surface.glsl"

vec4 shade(Pixel pixel) {
    ivec2 at = pixel.texel;
    vec2 own = load(ssao_tile, at).rg;
    vec4 sides = vec4(load_clamped(ssao_tile, at - ivec2(4, 0)).r, load_clamped(ssao_tile, at + ivec2(4, 0)).r,
                      load_clamped(ssao_tile, at - ivec2(0, 4)).r, load_clamped(ssao_tile, at + ivec2(0, 4)).r);
    vec4 corners = vec4(load_clamped(ssao_tile, at - ivec2(4, 4)).r, load_clamped(ssao_tile, at + ivec2(4, 4)).r,
                        load_clamped(ssao_tile, at - ivec2(4, -4)).r, load_clamped(ssao_tile, at + ivec2(4, -4)).r);
    vec2 slope = 4.0 * ssao_slope_of(own.g);
    float tolerance = ssao_tolerance(own.r, slope), per_own = 1.0 / own.r, falls = slope.x + slope.y, turns = slope.x - slope.y;
    vec4 side = ssao_weight(sides * per_own - 1.0 - vec4(-slope.x, slope.x, -slope.y, slope.y), tolerance);
    vec4 corner = ssao_weight(corners * per_own - 1.0 - vec4(-falls, falls, -turns, turns), tolerance);
    side = 0.5 * min(side, side.yxwz);
    corner = 0.25 * min(corner, corner.yxwz);
    float sum = dot(ssao_visibility(sides), side) + dot(ssao_visibility(corners), corner) + ssao_visibility(own.rrrr).r;
    return vec4(ssao_with(own.r, sum / (dot(side + corner, vec4(1.0)) + 1.0)), own.g, 0.0, 0.0);
}
