// SPDX-License-Identifier: MIT
// One direction of a 5 x 5 Gaussian, over pixels whose distance, in alpha, is like this one's.

vec4 shade(Pixel pixel) {
    vec4 own = load(volumetric_light, pixel.texel);
    float falloff = 10.0 / max(own.a, 1e-3);
    vec3 sum = own.rgb;
    float weights = 1.0;
    for (int i = -2; i <= 2; ++i) {
        if (i == 0) continue;
        vec4 tap = load(volumetric_light, clamp(pixel.texel + ivec2(0, i), ivec2(0), pixel.size - 1));
        float weight = exp(-0.2 * float(i * i)) * max(1.0 - falloff * abs(tap.a - own.a), 0.0);
        sum += tap.rgb * weight;
        weights += weight;
    }
    return vec4(sum / weights, own.a);
}
