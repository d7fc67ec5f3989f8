// SPDX-License-Identifier: MIT
// The mean over the tile of the noise, of those pixels that lie in the surface here. The tile reaches from two pixels before
// this one to one after; the upsampling makes up for the half pixel. Beside it the surface's slope.
#include "ssao_packed.glsl"
#include "ssao_surface.glsl"

// That from the pixel before, if the second before lies on the same line, so at a ridge, too; else the lesser of both sides',
// and none at a ridge. Continuous in all four.
float ssao_slope(float second, float before, float here, float after, float per_bend) {
    float a = here - before, b = after - here, lesser = max(min(a, b), 0.0) + min(max(a, b), 0.0);
    return mix(lesser, a, clamp(2.0 - abs(before - second - a) * per_bend, 0.0, 1.0));
}

vec4 shade(Pixel pixel) {
    vec2 texel = 1.0 / vec2(pixel.size);
    vec2 low = (vec2(pixel.texel) - 1.0) * texel, high = (vec2(pixel.texel) + 1.0) * texel;
    vec4 packed_00 = gather_red(ssao_raw, low), packed_10 = gather_red(ssao_raw, vec2(high.x, low.y));
    vec4 packed_01 = gather_red(ssao_raw, vec2(low.x, high.y)), packed_11 = gather_red(ssao_raw, high);
    // Order of a gather: (0,1), (1,1), (1,0), (0,0).
    float own = ssao_near(packed_11.w), per_own = 1.0 / own, per_bend = per_own / max(0.15 * ssao_width(own), 3e-4);
    vec2 slope = per_own * vec2(ssao_slope(ssao_near(packed_01.w), ssao_near(packed_01.z), own, ssao_near(packed_11.z), per_bend),
                                ssao_slope(ssao_near(packed_10.w), ssao_near(packed_10.x), own, ssao_near(packed_11.x), per_bend));
    float tolerance = ssao_tolerance(own, slope);
    vec4 expected = 1.0 + slope.x * vec4(0.0, 1.0, 1.0, 0.0) + slope.y * vec4(1.0, 1.0, 0.0, 0.0);
    vec4 weight_00 = ssao_weight(packed_00 * per_own - (expected - 2.0 * (slope.x + slope.y)), tolerance);
    vec4 weight_10 = ssao_weight(packed_10 * per_own - (expected - 2.0 * slope.y), tolerance);
    vec4 weight_01 = ssao_weight(packed_01 * per_own - (expected - 2.0 * slope.x), tolerance);
    vec4 weight_11 = ssao_weight(packed_11 * per_own - expected, tolerance);
    float sum = dot(ssao_visibility(packed_00), weight_00) + dot(ssao_visibility(packed_10), weight_10) +
                dot(ssao_visibility(packed_01), weight_01) + dot(ssao_visibility(packed_11), weight_11);
    // Its own weight is one.
    float seen = sum / dot(weight_00 + weight_10 + weight_01 + weight_11, vec4(1.0));
    return vec4(ssao_with(own, seen), ssao_pack_slope(slope), 0.0, 0.0);
}
