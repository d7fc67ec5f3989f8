// SPDX-License-Identifier: MIT
// View-space normals from planar distance: of each axis the neighbour that differs less, so that edges do not bend them.
// custom[0].x: pixels of the distance image for one here.
#include "shared/camera.glsl"

vec3 shared_position(ivec2 texel) {
    return view_position((vec2(texel) + 0.5) / vec2(size(shared_linear_depth)),
                         load_clamped(shared_linear_depth, texel).r);
}

// The difference along one axis, in its direction; at the picture's edge there is one neighbour only.
vec3 shared_slope(vec3 here, vec3 before, vec3 after, bool is_first, bool is_last) {
    bool takes_after = is_first || (!is_last && abs(after.z - here.z) < abs(here.z - before.z));
    return takes_after ? after - here : here - before;
}

vec4 shade(Pixel pixel) {
    ivec2 texel = pixel.texel * int(custom[0].x), last = size(shared_linear_depth) - 1;
    vec3 here = shared_position(texel);
    vec3 along_x = shared_slope(here, shared_position(texel - ivec2(1, 0)), shared_position(texel + ivec2(1, 0)),
                                texel.x == 0, texel.x == last.x);
    vec3 along_y = shared_slope(here, shared_position(texel - ivec2(0, 1)), shared_position(texel + ivec2(0, 1)),
                                texel.y == 0, texel.y == last.y);
    // v runs down, so this order faces the camera.
    vec3 normal = cross(along_y, along_x);
    float squared = dot(normal, normal);
    return vec4(squared > 0.0 ? normal * inversesqrt(squared) : vec3(0.0, 0.0, 1.0), 0.0);
}
