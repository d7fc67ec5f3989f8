// SPDX-License-Identifier: MIT
// Any domain. RCAS, or CAS (Timothy Lottes, "FidelityFX Contrast Adaptive Sharpening", 2019); but that the range of values
// goes on where the brightest pixel is above 1, and the result stays within the span of the five pixels.
#include "shared/rcas.glsl"
#include "shared/sanitize.glsl"

vec3 sharpen_at(int x, int y) { return sanitize(load(picture, ivec2(x, y))).rgb; }

// Beyond 1 there is as much room above the brightest as it lies above 1.
float sharpen_peak(vec3 brightest) { return max(2.0 * max(brightest.r, max(brightest.g, brightest.b)) - 1.0, 1.0); }

// The share of a neighbour that `strength` 1 allows.
const float sharpen_cas_share = 0.2;

// `low`, `high`: of the pixel and the four beside it. Those at its corners count once, the others twice, for how much room
// there is.
vec3 sharpen_cas(ivec2 before, ivec2 behind, vec3 own, vec3 around, vec3 low, vec3 high, float strength) {
    vec3 nw = sharpen_at(before.x, before.y), ne = sharpen_at(behind.x, before.y);
    vec3 sw = sharpen_at(before.x, behind.y), se = sharpen_at(behind.x, behind.y);
    vec3 lowest = min(min(min(nw, ne), min(sw, se)), low), highest = max(max(max(nw, ne), max(sw, se)), high);
    vec3 both_low = low + lowest, both_high = high + highest;
    vec3 room = min(both_low, 2.0 * sharpen_peak(highest) - both_high) / max(both_high, 1e-30);
    vec3 lobe = sqrt(clamp(room, 0.0, 1.0)) * (-sharpen_cas_share * strength);
    return clamp((lobe * around + own) / (4.0 * lobe + 1.0), low, high);
}

vec4 sharpen(Pixel pixel, Sharpen parameters) {
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(picture) - 1);
    vec4 own = load(picture, texel);
    vec3 c = sanitize(own).rgb;
    vec3 n = sharpen_at(texel.x, before.y), s = sharpen_at(texel.x, behind.y);
    vec3 w = sharpen_at(before.x, texel.y), e = sharpen_at(behind.x, texel.y);
    vec3 brightest = max(max(max(n, s), max(w, e)), c);
    float strength = exp2(parameters.stops);
    if (parameters.mode == Sharpen_mode_rcas) return vec4(rcas(c, n, s, w, e, sharpen_peak(brightest), strength), own.a);
    vec3 darkest = min(min(min(n, s), min(w, e)), c);
    return vec4(sharpen_cas(before, behind, c, n + s + w + e, darkest, brightest, strength), own.a);
}
