// SPDX-License-Identifier: MIT
// The planar distance, negative where the frame has a normal of no length: what is there, a sprite, neither occludes nor
// is occluded. custom[0] and [1].x: the constants of planar_distance(); [1].y: 1 where a pixel here is the first of 2 x 2.
#include "shared/planar_distance.glsl"

vec4 shade(Pixel pixel) {
    ivec2 texel = pixel.texel << int(custom[1].y);
    vec3 normal = load(shared_normals, texel).xyz;
    float planar = planar_distance(load(shared_depth, texel).r, custom[0], custom[1].x);
    return vec4(dot(normal, normal) > 0.0 ? planar : -planar, 0.0, 0.0, 0.0);
}
