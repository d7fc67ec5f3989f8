// SPDX-License-Identifier: MIT
// Scene-linear. RCAS (AMD, "FidelityFX Super Resolution 1.0", 2021) of what will be shown, c / (1 + max c) of exposed
// light, within the span of the five pixels. custom[0].x = strength.

vec3 taa_shown_at(int x, int y, float unit) {
    vec3 light = load(taa_gathered, ivec2(x, y)).rgb;
    return light / (unit + max(light.r, max(light.g, light.b)));
}

vec4 shade(Pixel pixel) {
    float unit = 1.0 / clamp(load(taa_exposure, ivec2(0)).r, 1e-6, 1e6);
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(taa_gathered) - 1);
    vec4 own = load(taa_gathered, texel);
    vec3 e = own.rgb / (unit + max(own.r, max(own.g, own.b)));
    vec3 n = taa_shown_at(texel.x, before.y, unit), s = taa_shown_at(texel.x, behind.y, unit);
    vec3 w = taa_shown_at(before.x, texel.y, unit), o = taa_shown_at(behind.x, texel.y, unit);
    vec3 low = min(min(n, s), min(w, o)), high = max(max(n, s), max(w, o));
    vec3 darkest = min(low, e), brightest = max(high, e);
    vec3 down = darkest / max(4.0 * high, 1e-30), up = (1.0 - brightest) / max(4.0 - 4.0 * low, 1e-30);
    vec3 most = min(down, up);
    float lobe = -min(min(most.r, min(most.g, most.b)), 0.1875) * custom[0].x;
    vec3 sharp = clamp((lobe * (n + s + w + o) + e) / (4.0 * lobe + 1.0), darkest, brightest);
    return vec4(min(sharp * unit / max(1.0 - max(sharp.r, max(sharp.g, sharp.b)), 1e-7), vec3(65504.0)), own.a);
}
