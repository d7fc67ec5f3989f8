// SPDX-License-Identifier: MIT
// Device depth to planar distance, metres; 1e10 is sky. `distance` and `sky` are DepthConstants of scene_images.hpp. What is
// no number is sky, too: min takes its other operand.
#ifndef shared_planar_distance
#define shared_planar_distance
float planar_distance(float depth, vec4 distance, float sky) {
    float planar = (depth * distance.x + distance.y) / (depth * distance.z + distance.w);
    return depth == sky ? 1e10 : max(min(planar, 1e10), 0.0);
}
vec4 planar_distance(vec4 depth, vec4 distance, float sky) {
    vec4 planar = (depth * distance.x + distance.y) / (depth * distance.z + distance.w);
    return mix(max(min(planar, 1e10), 0.0), vec4(1e10), equal(depth, vec4(sky)));
}
#endif
