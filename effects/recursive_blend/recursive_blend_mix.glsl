// SPDX-License-Identifier: MIT
// Any domain. custom[0] = (what is left of the past, steps that the result is rounded to or 0).
#include "shared/sanitize.glsl"

// Weights such as 0.9 are a little less in floats, and what is half way between two steps goes up all the same.
const float recursive_blend_half = 0.5 + 1.0 / 4096.0;

vec4 shade(Pixel pixel) {
    vec4 now = sanitize(load(recursive_blend_picture, pixel.texel));
    vec3 past = load(recursive_blend_past, pixel.texel).rgb;
    vec3 mixed = now.rgb * (1.0 - custom[0].x) + past * custom[0].x;
    float steps = custom[0].y;
    if (steps > 0.0) mixed = floor(clamp(mixed, 0.0, 1.0) * steps + recursive_blend_half) / steps;
    return vec4(mixed, now.a);
}
