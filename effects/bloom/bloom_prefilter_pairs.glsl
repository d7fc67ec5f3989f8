// SPDX-License-Identifier: MIT
// The scene to level 0, two pixels side by side at once, so that they take 18 taps and not 26.
#include "shared/sanitize.glsl"

vec3 bloom_tap(int from, vec2 place) {
    return sanitize_light(sample_linear(bloom_source, place * (0.5 / vec2(size(bloom_level_0)))).rgb);
}

#include "bloom_taps.glsl"
#include "bloom_average.glsl"

void run() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) * ivec2(2, 1), extent = size(bloom_level_0);
    if (any(greaterThanEqual(texel, extent))) return;
    BloomTaps taps[2] = bloom_taps_of_pair(0, texel, size(bloom_source));
    store(bloom_level_0, texel, bloom_bright_part(bloom_average(taps[0])));
    if (texel.x + 1 < extent.x) store(bloom_level_0, texel + ivec2(1, 0), bloom_bright_part(bloom_average(taps[1])));
}
