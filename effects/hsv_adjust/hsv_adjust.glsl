// SPDX-License-Identifier: MIT
// Any domain. Alvy Ray Smith, "Color Gamut Transform Pairs", 1978: the hexcone model. Hues are in sixths of a turn.
#include "shared/sanitize.glsl"

float hsv_adjust_hue(vec3 color, float value, float chroma) {
    if (chroma <= 0.0) return 0.0;
    if (value == color.r) return (color.g - color.b) / chroma;
    if (value == color.g) return (color.b - color.r) / chroma + 2.0;
    return (color.r - color.g) / chroma + 4.0;
}

vec4 hsv_adjust(vec4 color, Pixel pixel, HsvAdjust parameters) {
    vec3 rgb = sanitize_light(color.rgb);
    float value = max(max(rgb.r, rgb.g), rgb.b);
    float chroma = value - min(min(rgb.r, rgb.g), rgb.b);
    float hue = hsv_adjust_hue(rgb, value, chroma) + parameters.hue / 60.0;
    chroma = min(chroma * parameters.saturation, value);
    // How far each channel lies below the value: 0 for a third of the turn around its own hue, 1 opposite.
    vec3 turn = mod(hue + vec3(5.0, 3.0, 1.0), 6.0);
    vec3 below = clamp(min(turn, 4.0 - turn), 0.0, 1.0);
    return vec4((value - chroma * below) * parameters.value, color.a);
}
