// SPDX-License-Identifier: MIT
// Any domain. RCAS, but that the range of values goes on where the brightest pixel is above 1.
#include "shared/rcas.glsl"
#include "shared/sanitize.glsl"

vec3 sharpen_at(int x, int y) { return sanitize(load(picture, ivec2(x, y))).rgb; }

vec4 sharpen(Pixel pixel, Sharpen parameters) {
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(picture) - 1);
    vec4 own = load(picture, texel);
    vec3 c = sanitize(own).rgb;
    vec3 n = sharpen_at(texel.x, before.y), s = sharpen_at(texel.x, behind.y);
    vec3 w = sharpen_at(before.x, texel.y), e = sharpen_at(behind.x, texel.y);
    vec3 brightest = max(max(max(n, s), max(w, e)), c);
    // Beyond 1 there is as much room above the brightest as it lies above 1.
    float peak = max(2.0 * max(brightest.r, max(brightest.g, brightest.b)) - 1.0, 1.0);
    return vec4(rcas(c, n, s, w, e, peak, exp2(parameters.stops)), own.a);
}
