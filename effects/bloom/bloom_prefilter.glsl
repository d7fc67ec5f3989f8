// SPDX-License-Identifier: MIT
// The scene to level 0, a kernel of a pixel: 13 taps, averaged as five overlapping boxes, then the threshold.
#include "shared/sanitize.glsl"
#include "bloom_prefilter_taps.glsl"
#include "bloom_average.glsl"

vec4 shade(Pixel pixel) {
    return bloom_bright_part(bloom_average(bloom_taps(pixel)));
}
