// SPDX-License-Identifier: MIT
// Every pixel counts.
const bool auto_exposure_has_mask = false;

float auto_exposure_mask_at(ivec2 texel, ivec2 extent) { return 1.0; }

#include "auto_exposure_counting.glsl"
