// SPDX-License-Identifier: MIT
// View-space normals of the first pixel of every two by two, from the host's depth: by custom[2] and custom[3].x.
#include "shared/normal_of_distances.glsl"
#include "shared/planar_distance.glsl"

vec4 shade(Pixel pixel) {
    ivec2 texel = pixel.texel * 2, extent = size(shared_depth);
    // In the order of a gather: (0,1), (1,1), (1,0), (0,0).
    vec4 before = gather_red(shared_depth, vec2(texel) / vec2(extent));
    vec4 after = gather_red(shared_depth, (vec2(texel) + 1.0) / vec2(extent));
    vec4 around = planar_distance(vec4(before.x, before.z, after.z, after.x), custom[2], custom[3].x);
    return shared_normal(texel, extent - 1, planar_distance(after.w, custom[2], custom[3].x), around);
}
