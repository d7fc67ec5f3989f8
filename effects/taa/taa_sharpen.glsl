// SPDX-License-Identifier: MIT
// Scene-linear. RCAS of what will be shown, c / (1 + max c) of exposed light, which ends at 1. custom[0].x = strength.
#include "shared/rcas.glsl"
#include "taa_tone.glsl"

vec3 taa_shown_at(int x, int y, float unit) { return taa_toned(load(taa_gathered, ivec2(x, y)).rgb, unit); }

vec4 shade(Pixel pixel) {
    float unit = exp2(taa_stops_of(load(taa_exposure, ivec2(0)).r));
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(taa_gathered) - 1);
    vec4 own = load(taa_gathered, texel);
    vec3 n = taa_shown_at(texel.x, before.y, unit), s = taa_shown_at(texel.x, behind.y, unit);
    vec3 w = taa_shown_at(before.x, texel.y, unit), e = taa_shown_at(behind.x, texel.y, unit);
    vec3 sharp = rcas(taa_toned(own.rgb, unit), n, s, w, e, 1.0, custom[0].x);
    return vec4(taa_light(sharp, unit), own.a);
}
