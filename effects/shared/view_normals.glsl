// SPDX-License-Identifier: MIT
// The frame's world-space normals in view space. custom[0].x: 1 where a pixel here is the first of 2 x 2.
#include "shared/camera.glsl"

vec4 shade(Pixel pixel) {
    vec3 normal = view_direction(load(shared_normals, pixel.texel << int(custom[0].x)).xyz);
    float squared = dot(normal, normal);
    return vec4(squared > 0.0 ? normal * inversesqrt(squared) : vec3(0.0, 0.0, 1.0), 0.0);
}
