// SPDX-License-Identifier: MIT
// Blend modes for any domain. In [0, 1] they are the usual ones; beyond, no mode makes light vanish that the usual formula
// would turn negative.
#ifndef SHARED_BLEND_MODES
#define SHARED_BLEND_MODES

const uint blend_mode_mix = 0u;
const uint blend_mode_add = 1u;
const uint blend_mode_screen = 2u;
const uint blend_mode_multiply = 3u;
const uint blend_mode_lighten = 4u;
const uint blend_mode_darken = 5u;
const uint blend_mode_difference = 6u;
const uint blend_mode_overlay = 7u;
const uint blend_mode_soft_light = 8u;

// 1 - (1 - a)(1 - b) in [0, 1]. Only the parts in [0, 1] are multiplied, so it never falls when one side grows.
vec3 blend_screen(vec3 base, vec3 layer) {
    return base + layer - clamp(base, 0.0, 1.0) * clamp(layer, 0.0, 1.0);
}

vec3 blend_colors(vec3 base, vec3 layer, uint mode) {
    if (mode == blend_mode_add) return base + layer;
    if (mode == blend_mode_screen) return blend_screen(base, layer);
    if (mode == blend_mode_multiply) return base * layer;
    if (mode == blend_mode_lighten) return max(base, layer);
    if (mode == blend_mode_darken) return min(base, layer);
    if (mode == blend_mode_difference) return abs(base - layer);
    if (mode == blend_mode_overlay) {
        // Multiply doubled below a base of one half, screen above: equal there.
        return mix(blend_screen(2.0 * base - 1.0, layer), 2.0 * base * layer, lessThan(base, vec3(0.5)));
    }
    if (mode == blend_mode_soft_light) {
        // The form without a step in its slope: base^2 for layer 0, 2 base - base^2 for layer 1.
        vec3 inside = clamp(base, 0.0, 1.0);
        return base + (2.0 * clamp(layer, 0.0, 1.0) - 1.0) * inside * (1.0 - inside);
    }
    return layer;
}
#endif
