// SPDX-License-Identifier: MIT
// How a stack entry's result goes over the picture it was made from: its opacity, its blend mode, its mask.
#ifndef SHARED_MERGE
#define SHARED_MERGE
#include "shared/blend_modes.glsl"

float mask_weight(vec4 mask) {
    return clamp(dot(mask.rgb, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0);
}

// Opacity 1 returns the layer's own bits: a plain mix would turn an infinite base into NaN.
vec4 merge_layer(vec4 base, vec4 layer, float opacity, uint mode) {
    vec3 blended = mode == 0u ? layer.rgb : blend_colors(base.rgb, layer.rgb, mode);
    return opacity == 1.0 ? vec4(blended, layer.a) : mix(base, vec4(blended, layer.a), opacity);
}
#endif
