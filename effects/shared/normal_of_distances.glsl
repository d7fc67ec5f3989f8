// SPDX-License-Identifier: MIT
// A view-space normal from planar distances: of each axis the neighbour that differs less, so that edges do not bend it.
// custom[0], custom[1].xy: RayConstants of the frame's pixels.

// The difference to the neighbour taken, and that one's distance. At the picture's edge there is one neighbour only.
vec2 shared_step(float before, float here, float after, bool is_first, bool is_last) {
    bool takes_after = is_first || (!is_last && abs(after - here) < abs(here - before));
    return takes_after ? vec2(after - here, after) : vec2(here - before, before);
}

// `around`: left, above, right, below.
vec4 shared_normal(ivec2 texel, ivec2 last, float here, vec4 around) {
    vec2 x = shared_step(around.x, here, around.z, texel.x == 0, texel.x == last.x);
    vec2 y = shared_step(around.y, here, around.w, texel.y == 0, texel.y == last.y);
    // Of positions, each (ray * distance + flat, -distance), with ray and flat linear in the pixel.
    vec2 ray = vec2(texel) * custom[0].xy + custom[0].zw;
    vec3 along_x = vec3(ray.x * x.x + custom[0].x * x.y + custom[1].x, ray.y * x.x, -x.x);
    vec3 along_y = vec3(ray.x * y.x, ray.y * y.x + custom[0].y * y.y + custom[1].y, -y.x);
    // v runs down, so this order faces the camera.
    vec3 normal = cross(along_y, along_x);
    float squared = dot(normal, normal);
    return vec4(squared > 0.0 ? normal * inversesqrt(squared) : vec3(0.0, 0.0, 1.0), 0.0);
}
