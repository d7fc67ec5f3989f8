// SPDX-License-Identifier: MIT
// A grid of vertices, of which the outer ones lie on the picture's edge: where a linear tap of it gives the value at
// uv, and the uv of the vertex that a pass writes.

vec2 grid_uv(vec2 uv, ivec2 vertices) { return (uv * vec2(vertices - 1) + 0.5) / vec2(vertices); }

vec2 grid_vertex(Pixel pixel) { return vec2(pixel.texel) / vec2(pixel.size - 1); }
