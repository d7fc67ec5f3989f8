// SPDX-License-Identifier: MIT
// Levels 2 and 4: taps of four texels each, as a workgroup makes them that has the level above in shared memory.
vec3 bloom_texel(int from, ivec2 texel) {
    return load(bloom_above, texel).rgb;
}

#include "bloom_texels.glsl"

vec3 bloom_tap(int from, vec2 place) {
    return bloom_between(from, place, size(bloom_above), output_size());
}

#include "bloom_downsample_pixel.glsl"
