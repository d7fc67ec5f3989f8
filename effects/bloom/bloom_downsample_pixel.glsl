// SPDX-License-Identifier: MIT
// Level i-1 to level i, a kernel of a pixel: by the 13 taps. Who includes this defines bloom_tap().
#include "bloom_taps.glsl"

vec4 shade(Pixel pixel) {
    return vec4(bloom_mean_of(bloom_taps_of(0, pixel.texel, size(bloom_above))), 1.0);
}
