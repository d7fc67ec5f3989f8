// SPDX-License-Identifier: MIT
// The way in the vertices of the grid, in pixels.
#include "lens_distortion_way.glsl"
#include "shared/warp_grid.glsl"

vec4 shade(Pixel pixel) {
    vec2 extent = 2.0 * custom[0].xy * custom[1].w;
    return lens_distortion_way(grid_vertex(pixel), custom[0], custom[1]) * extent.xyxy;
}
