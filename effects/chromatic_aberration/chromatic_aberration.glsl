// SPDX-License-Identifier: MIT
// Any domain. Distances in uv.
#include "shared/sanitize.glsl"

vec4 chromatic_aberration(Pixel pixel, ChromaticAberration parameters) {
    vec4 own = load_clamped(picture, pixel.texel);
    vec2 offset = (pixel.uv - 0.5) * (parameters.chromatic_aberration * 0.012);
    own.r = sample_linear(picture, pixel.uv + offset).r;
    own.b = sample_linear(picture, pixel.uv - offset).b;
    return vec4(sanitize(own).rgb, own.a);
}
