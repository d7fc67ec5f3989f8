// SPDX-License-Identifier: MIT
// Levels 1 and 3: taps by the sampler.
vec3 bloom_tap(int from, vec2 place) {
    return sample_linear(bloom_above, place * (0.5 / vec2(output_size()))).rgb;
}

#include "bloom_downsample_pixel.glsl"
