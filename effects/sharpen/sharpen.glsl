// SPDX-License-Identifier: MIT
// Any domain. AMD, "FidelityFX Super Resolution 1.0", 2021, robust contrast-adaptive sharpening (RCAS); but that the range
// of values goes on where the brightest pixel is above 1, and the result stays within the span of the five pixels.
#include "shared/sanitize.glsl"

// The strongest that a neighbour may weigh: beyond it the published method amplifies noise.
const float sharpen_limit = 0.25 - 1.0 / 16.0;

vec3 sharpen_at(int x, int y) { return sanitize(load(picture, ivec2(x, y))).rgb; }

vec4 sharpen(Pixel pixel, Sharpen parameters) {
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(picture) - 1);
    vec4 own = load(picture, texel);
    vec3 e = sanitize(own).rgb;
    vec3 n = sharpen_at(texel.x, before.y), s = sharpen_at(texel.x, behind.y);
    vec3 w = sharpen_at(before.x, texel.y), o = sharpen_at(behind.x, texel.y);
    vec3 low = min(min(n, s), min(w, o)), high = max(max(n, s), max(w, o));
    vec3 darkest = min(low, e), brightest = max(high, e);
    // Beyond 1 there is as much room above the brightest as it lies above 1.
    float peak = max(2.0 * max(brightest.r, max(brightest.g, brightest.b)) - 1.0, 1.0);

    // How much all neighbours may weigh until a channel would reach 0 or the peak, were they all as `low` or `high`.
    vec3 down = max(darkest, 0.0) / max(4.0 * high, 1e-30), up = (peak - brightest) / max(4.0 * (peak - low), 1e-30);
    vec3 most = min(down, up);
    float lobe = -min(min(most.r, min(most.g, most.b)), sharpen_limit) * exp2(parameters.stops);
    vec3 sharp = (lobe * (n + s + w + o) + e) / (4.0 * lobe + 1.0);
    return vec4(clamp(sharp, darkest, brightest), own.a);
}
