// SPDX-License-Identifier: MIT
// By how many pixels the circle that a point is seen as lies below the largest, where the lens focuses by itself: what
// depth_of_field_circle() then takes for the depth. custom[0] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y),
// custom[1] = (radius of a circle by the dioptres between it and what is sharp, focal length, largest radius, depth of the
// sky), custom[2].x = dioptres of the nearest distance that the lens can make sharp.
vec4 shade(Pixel pixel) {
    float depth = load(depth_of_field_depth, pixel.texel).r;
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    float dioptres = min(depth_of_field_focus[1], custom[2].x), largest = custom[1].z;
    float circle = custom[1].x / (1.0 - custom[1].y * dioptres) * (dioptres - inverse);
    return vec4(largest - clamp(circle, -largest, largest));
}
