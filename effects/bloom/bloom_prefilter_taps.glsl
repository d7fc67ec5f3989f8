// SPDX-License-Identifier: MIT
// The 13 taps of the prefilter, cleaned, by the sampler.

vec3 bloom_tap(int from, vec2 place) {
    return sanitize_light(sample_linear(bloom_source, place * (0.5 / vec2(output_size()))).rgb);
}

#include "bloom_taps.glsl"

BloomTaps bloom_taps(Pixel pixel) {
    return bloom_taps_of(0, pixel.texel, size(bloom_source));
}
