// SPDX-License-Identifier: MIT
// Pixels count as much as a picture says that is stretched over theirs.
const bool auto_exposure_has_mask = true;

float auto_exposure_mask_at(ivec2 texel, ivec2 extent) {
    return sample_linear(auto_exposure_mask, (vec2(texel) + 0.5) / vec2(extent)).r;
}

#include "auto_exposure_counting.glsl"
