// SPDX-License-Identifier: MIT
// AMD, "FidelityFX Super Resolution 1.0", 2021, robust contrast-adaptive sharpening (RCAS); but that the result stays within
// the span of the five pixels.
#ifndef SHARED_RCAS
#define SHARED_RCAS

// The strongest that a neighbour may weigh: beyond it the published method amplifies noise.
const float rcas_limit = 0.25 - 1.0 / 16.0;

// The pixel and those above, below, left and right of it, whose values end at `peak`. `strength`: 1 is all that is allowed.
vec3 rcas(vec3 own, vec3 n, vec3 s, vec3 w, vec3 e, float peak, float strength) {
    vec3 low = min(min(n, s), min(w, e)), high = max(max(n, s), max(w, e));
    vec3 darkest = min(low, own), brightest = max(high, own);
    // How much all neighbours may weigh until a channel would reach 0 or the peak, were they all as `low` or `high`.
    vec3 down = max(darkest, 0.0) / max(4.0 * high, 1e-30), up = (peak - brightest) / max(4.0 * (peak - low), 1e-30);
    vec3 most = min(down, up);
    float lobe = -min(min(most.r, min(most.g, most.b)), rcas_limit) * strength;
    return clamp((lobe * (n + s + w + e) + own) / (4.0 * lobe + 1.0), darkest, brightest);
}
#endif
