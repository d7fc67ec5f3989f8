// SPDX-License-Identifier: MIT
#part grid end
// How far what is seen at uv lies from there, in pixels. frame = (phases of the sines in turns, radius of the ring in
// heights of the picture, its amplitude in pixels).

float perturb_bump(float place) {
    float half_wave = cos(1.57079633 * place);
    return abs(place) < 1.0 ? half_wave * half_wave : 0.0;
}

// `sines`: of 2 pi (strength.z v + phase.x) and of 2 pi (strength.w u + phase.y).
vec2 perturb_sum(vec2 uv, vec2 sines, vec2 image, vec4 frame, vec2 size, Perturb parameters) {
    vec2 shift = parameters.strength.xy * sines;
    vec2 from_center = (uv - parameters.ring_center) * vec2(size.x / size.y, 1.0);
    float radius = length(from_center);
    float bump = frame.w * perturb_bump((radius - frame.z) / parameters.ring_width);
    shift -= from_center * (bump / max(radius, 1e-6));
    shift += parameters.distortion_strength * (2.0 * image - 1.0);
    float pixel = parameters.reach == Perturb_reach_height ? size.y / 1080.0 : 1.0;
    return parameters.amount * pixel * shift;
}

vec2 perturb_turns(vec2 uv, vec4 frame, Perturb parameters) {
    return fract(parameters.strength.zw * uv.yx + frame.xy);
}

#part grid end
// The image of displacements, repeated, with linear interpolation across the seam.

// `texel` lies in the image or one beside it. Not by %, which SPIR-V leaves open for numbers below 0.
vec2 perturb_texel(ivec2 texel) {
    ivec2 extent = size(perturb_distortion);
    texel += extent * (ivec2(lessThan(texel, ivec2(0))) - ivec2(greaterThanEqual(texel, extent)));
    return load(perturb_distortion, texel).rg;
}

vec2 perturb_image(vec2 uv) {
    vec2 place = fract(uv) * vec2(size(perturb_distortion)) - 0.5;
    ivec2 first = ivec2(floor(place));
    vec2 within = place - floor(place);
    vec2 top = mix(perturb_texel(first), perturb_texel(first + ivec2(1, 0)), within.x);
    vec2 bottom = mix(perturb_texel(first + ivec2(0, 1)), perturb_texel(first + 1), within.x);
    return mix(top, bottom, within.y);
}

#part grid
// The shifts in the vertices of the grid, in pixels. custom[0] = (phases, radius and amplitude of the ring), custom[1] =
// (size of the picture, is there an image, has the CPU moved the vertices); if so, two vertices a vector follow.
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

#part end
// Any domain. perturb_custom(0) = (phases, radius and amplitude of the ring), perturb_custom(1) = (size of the picture,
// is there an image).
#include "shared/sanitize.glsl"
#include "shared/warp_grid.glsl"

float perturb_table_sine(float turns) {
    float place = turns * float(size(perturb_sines).x);
    int first = int(place);
    int next = first + 1 < size(perturb_sines).x ? first + 1 : 0;
    return mix(load_clamped(perturb_sines, ivec2(first, 0)).r, load(perturb_sines, ivec2(next, 0)).r, fract(place));
}

vec2 perturb_sines_at(vec2 turns, Perturb parameters) {
    if (parameters.evaluation == Perturb_evaluation_sine_table)
        return vec2(perturb_table_sine(turns.x), perturb_table_sine(turns.y));
    return sin(6.28318531 * turns);
}

vec4 perturb(Pixel pixel, Perturb parameters) {
    vec2 extent = perturb_custom(1).xy;
    vec2 shift;
    bool is_grid = parameters.evaluation == Perturb_evaluation_vertex || parameters.evaluation == Perturb_evaluation_cpu;
    if (is_grid && size(perturb_vertices).x > 1) {
        shift = sample_linear(perturb_vertices, grid_uv(pixel.uv, size(perturb_vertices))).rg;
    } else {
        vec4 frame = perturb_custom(0);
        vec2 image = perturb_custom(1).z != 0.0 ? perturb_image(pixel.uv + frame.xy) : vec2(0.5);
        vec2 sines = perturb_sines_at(perturb_turns(pixel.uv, frame, parameters), parameters);
        shift = perturb_sum(pixel.uv, sines, image, frame, extent, parameters);
    }
    return sanitize(sample_linear(picture, pixel.uv + shift / extent));
}
