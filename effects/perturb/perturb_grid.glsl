// SPDX-License-Identifier: MIT
// The shifts in the vertices of the grid, in pixels. custom[0] = (phases, radius and amplitude of the ring), custom[1] =
// (size of the picture, is there an image, has the CPU moved the vertices); if so, two vertices a vector follow.
#include "perturb_distortion.glsl"
#include "perturb_shift.glsl"
#include "shared/warp_grid.glsl"

vec4 shade(Pixel pixel) {
    Perturb parameters = perturb_parameters();
    if (custom[1].w != 0.0) {
        int vertex = pixel.texel.y * pixel.size.x + pixel.texel.x;
        vec4 pair = custom[2 + vertex / 2];
        return vec4(vertex % 2 == 0 ? pair.xy : pair.zw, 0.0, 0.0);
    }
    vec2 uv = grid_vertex(pixel);
    vec2 image = custom[1].z != 0.0 ? perturb_image(uv + custom[0].xy) : vec2(0.5);
    vec2 sines = sin(6.28318531 * perturb_turns(uv, custom[0], parameters));
    return vec4(perturb_sum(uv, sines, image, custom[0], custom[1].xy, parameters), 0.0, 0.0);
}
