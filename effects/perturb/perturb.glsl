// SPDX-License-Identifier: MIT
// Any domain. perturb_custom(0) = (phases, radius and amplitude of the ring), perturb_custom(1) = (size of the picture,
// is there an image).
#include "perturb_distortion.glsl"
#include "perturb_shift.glsl"
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
