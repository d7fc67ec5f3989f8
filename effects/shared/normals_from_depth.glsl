// SPDX-License-Identifier: MIT
// View-space normals of the pixels of shared_linear_depth.
#include "shared/normal_of_distances.glsl"

vec4 shade(Pixel pixel) {
    ivec2 texel = pixel.texel, last = size(shared_linear_depth) - 1;
    ivec2 low = max(texel - 1, ivec2(0)), high = min(texel + 1, last);
    vec4 around = vec4(load(shared_linear_depth, ivec2(low.x, texel.y)).r, load(shared_linear_depth, ivec2(texel.x, low.y)).r,
                       load(shared_linear_depth, ivec2(high.x, texel.y)).r, load(shared_linear_depth, ivec2(texel.x, high.y)).r);
    return shared_normal(texel, last, load(shared_linear_depth, texel).r, around);
}
