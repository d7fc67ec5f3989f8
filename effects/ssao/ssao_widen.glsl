// SPDX-License-Identifier: MIT
// The mean over this tile and the four beside it (after Holger Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform",
// 2010), of those pixels that lie in the surface here; each counts as far as its mean is of a whole tile (Hans Knutsson and
// Carl-Fredrik Westin, "Normalized and Differential Convolution", 1993). Of two that lie opposite each other both count
// nearly alike: what rises steadily, toward a corner of a room, stays as it is up to the corner. Where the mean here is of
// few pixels, before an edge and on thin parts, its noise is worse than what the rise loses, and one of the two will do.
#include "ssao_packed.glsl"
#include "ssao_surface.glsl"
#include "ssao_turned.glsl"

const float ssao_alike = 0.85;

vec4 shade(Pixel pixel) {
    ivec2 at = pixel.texel, left = at - ivec2(4, 0), right = at + ivec2(4, 0), above = at - ivec2(0, 4), below = at + ivec2(0, 4);
    vec2 own = load(ssao_tile, at).rg;
    vec2 a = load_clamped(ssao_tile, left).rg, b = load_clamped(ssao_tile, right).rg;
    vec2 c = load_clamped(ssao_tile, above).rg, d = load_clamped(ssao_tile, below).rg;
    vec4 sides = vec4(a.r, b.r, c.r, d.r);
    vec2 slope = 4.0 * ssao_slope_of(own.g);
    vec4 like = ssao_weight(sides * (1.0 / own.r) - 1.0 - vec4(-slope.x, slope.x, -slope.y, slope.y), ssao_tolerance(own.r, slope));
    like *= ssao_turned(load_clamped(ssao_normals, left).xyz, load_clamped(ssao_normals, right).xyz,
                        load_clamped(ssao_normals, above).xyz, load_clamped(ssao_normals, below).xyz,
                        load(ssao_normals, at).xyz * ssao_per_turn);
    float covered = ssao_covered(own.gggg).r;
    vec4 weight = mix(like, min(like, like.yxwz), ssao_alike / 64.0 * covered) * ssao_covered(vec4(a.g, b.g, c.g, d.g));
    float sum = dot(ssao_visibility(sides), weight) + ssao_visibility(own.rrrr).r * covered;
    return vec4(ssao_with(own.r, sum / (dot(weight, vec4(1.0)) + covered)), own.g, 0.0, 0.0);
}
