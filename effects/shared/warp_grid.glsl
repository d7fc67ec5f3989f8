// SPDX-License-Identifier: MIT
// Where a linear tap of a grid of vertices, of which the outer ones lie on the picture's edge, gives the value at uv.

vec2 grid_uv(vec2 uv, ivec2 vertices) { return (uv * vec2(vertices - 1) + 0.5) / vec2(vertices); }
