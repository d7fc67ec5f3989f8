// SPDX-License-Identifier: MIT
#part grid end
// How far from uv green is read (xy), and red further than it, and blue less (zw), in uv. frame = (the picture's half
// size where its half diagonal is 1, scale, ...), k = (coefficients of the squared distance and of its square, what is
// added to the first for red, half the diagonal in pixels).

vec4 lens_distortion_way(vec2 uv, vec4 frame, vec4 k) {
    vec2 from_centre = uv - 0.5;
    vec2 place = 2.0 * from_centre * frame.xy;
    float squared = dot(place, place);
    float green = frame.z * (1.0 + squared * (k.x + squared * k.y)) - 1.0;
    return vec4(from_centre * green, from_centre * (frame.z * squared * k.z));
}

#part grid
// The way in the vertices of the grid, in pixels.
#include "shared/warp_grid.glsl"

vec4 shade(Pixel pixel) {
    vec2 extent = 2.0 * custom[0].xy * custom[1].w;
    return lens_distortion_way(grid_vertex(pixel), custom[0], custom[1]) * extent.xyxy;
}

#part end
// Any domain. custom(0) and custom(1): see lens_distortion.glsl; custom(0).w = taps.
#include "shared/sanitize.glsl"
#include "shared/warp_grid.glsl"

// 1 in the picture; beyond, it falls to 0 within a pixel.
float lens_distortion_inside(vec2 uv, ivec2 size) {
    vec2 inside = clamp((0.5 - abs(uv - 0.5)) * vec2(size) + 1.0, 0.0, 1.0);
    return inside.x * inside.y;
}

vec4 lens_distortion(Pixel pixel, LensDistortion parameters) {
    vec4 frame = lens_distortion_custom(0), k = lens_distortion_custom(1);
    ivec2 vertices = size(lens_distortion_vertices);
    vec4 way;
    if (parameters.evaluation == LensDistortion_evaluation_vertex && vertices.x > 1) {
        vec2 extent = 2.0 * frame.xy * k.w;
        way = sample_linear(lens_distortion_vertices, grid_uv(pixel.uv, vertices)) / extent.xyxy;
    } else {
        way = lens_distortion_way(pixel.uv, frame, k);
    }
    // Green and alpha, then red, then blue: one round where the channels do not part, three where they do.
    vec4 color = vec4(0.0);
    int taps = int(frame.w), i = 0;
    do {
        vec2 uv = pixel.uv + way.xy + (i == 0 ? 0.0 : i == 1 ? 1.0 : -1.0) * way.zw;
        vec4 tap = sample_linear(picture, uv) * lens_distortion_inside(uv, pixel.size);
        color = i == 0 ? tap : i == 1 ? vec4(tap.r, color.gba) : vec4(color.rg, tap.b, color.a);
    } while (++i < taps);
    return sanitize(color);
}
