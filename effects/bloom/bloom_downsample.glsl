// SPDX-License-Identifier: MIT
// Level i-1 to level i.
#include "bloom_downsample_taps.glsl"

vec4 shade(Pixel pixel) {
    return vec4(bloom_by_taps(pixel), 1.0);
}
