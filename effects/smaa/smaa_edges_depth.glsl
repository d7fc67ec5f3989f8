// SPDX-License-Identifier: MIT
// smaa_edges.glsl, where the frame's depth says how much makes an edge: less where it jumps, more elsewhere. custom[0] and
// custom[1].x are the constants of the depth.
#include "shared/planar_distance.glsl"
#include "smaa_detect.glsl"

// By so much of the larger one inverse distances of two things differ.
const float smaa_depth_jump = 0.05;

float smaa_inverse_distance(ivec2 texel) {
    return 1.0 / max(planar_distance(load(smaa_depth, texel).r, custom[0], custom[1].x), 1e-4);
}

vec4 shade(Pixel pixel) {
    Smaa parameters = smaa_parameters();
    ivec2 texel = pixel.texel, before = max(texel - 1, 0);
    float own = smaa_inverse_distance(texel);
    vec2 beside = vec2(smaa_inverse_distance(ivec2(before.x, texel.y)), smaa_inverse_distance(ivec2(texel.x, before.y)));
    bvec2 is_jump = greaterThan(abs(own - beside), smaa_depth_jump * max(vec2(own), beside));
    vec2 scale = mix(vec2(1.0 + parameters.predication), vec2(1.0 - 0.5 * parameters.predication), is_jump);
    return smaa_detected(texel, parameters.threshold * scale);
}
