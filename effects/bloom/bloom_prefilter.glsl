// SPDX-License-Identifier: MIT
// The scene to level 0: 13 bilinear taps, averaged as five overlapping boxes, then the threshold. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.
#include "shared/sanitize.glsl"
#include "bloom_prefilter_taps.glsl"
#include "bloom_bright_part.glsl"

vec4 shade(Pixel pixel) {
    return bloom_bright_part(bloom_average(bloom_by_taps(pixel)));
}
