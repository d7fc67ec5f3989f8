// SPDX-License-Identifier: MIT
// The circle that a point is seen as, as its radius in texels of the blurred picture: negative before the distance that is
// sharp. custom[0] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y), custom[1] = (radius at infinity, that times
// the distance that is sharp, largest radius, depth of the sky), custom[2] = (pixels a texel, what depth_of_field_left()
// takes, and what depth_of_field_weight() does).
#include "depth_of_field_blur.glsl"

float depth_of_field_circle(float depth) {
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    return clamp(custom[1].x - custom[1].y * inverse, -custom[1].z, custom[1].z);
}

// The same with what is left to blur.
float depth_of_field_to_blur(float circle) {
    if (circle < 0.0) return -depth_of_field_left(-circle, custom[2].y, custom[2].x);
    return circle * custom[2].x < 2.0 ? 0.0 : sqrt(max(circle * circle - custom[2].y, 0.001));
}
