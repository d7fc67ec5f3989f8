// SPDX-License-Identifier: MIT
// By depth and by the frame's normals, which part the sides of an edge that both go on to a full-size pixel.
#include "shared/planar_distance.glsl"
#include "ssao_packed.glsl"
#include "ssao_turned.glsl"
#include "ssao_upsampled.glsl"

vec4 shade(Pixel pixel) {
    ivec2 first = pixel.texel * 2, next = min(pixel.texel + 1, pixel.size - 1) * 2;
    // Half-size pixel i holds full-size pixel 2i.
    vec3 own = load(ssao_frame_normals, first).xyz, right = load(ssao_frame_normals, ivec2(next.x, first.y)).xyz;
    vec3 below = load(ssao_frame_normals, ivec2(first.x, next.y)).xyz, far = load(ssao_frame_normals, next).xyz;
    vec3 at_01 = load_clamped(ssao_frame_normals, first + ivec2(0, 1)).xyz * ssao_per_turn;
    vec3 at_11 = load_clamped(ssao_frame_normals, first + 1).xyz * ssao_per_turn;
    vec3 at_10 = load_clamped(ssao_frame_normals, first + ivec2(1, 0)).xyz * ssao_per_turn;
    return ssao_upsampled(pixel, mat4(ssao_turned(below, far, right, own, at_01), ssao_turned(below, far, right, own, at_11),
                                      ssao_turned(below, far, right, own, at_10),
                                      ssao_turned(below, far, right, own, own * ssao_per_turn)));
}
