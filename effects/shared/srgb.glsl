// SPDX-License-Identifier: MIT
// IEC 61966-2-1, both ways. What lies outside [0, 1] is clamped, and NaN counts as 0.
#ifndef SHARED_SRGB
#define SHARED_SRGB

// All shaders are compiled so that a clamp takes NaN to its lower end.
vec3 srgb_range(vec3 color) { return clamp(color, 0.0, 1.0); }

// The power is a polynomial in x^(1/4), fitted by Remez exchange for the smallest relative error of the encoded value over
// [0.0031308, 1] with 1 kept exact: 3.3e-5 (2^-14.9), less than 1/100 of an 8-bit code.
vec3 srgb_encode(vec3 linear) {
    vec3 light = srgb_range(linear);
    vec3 s = sqrt(sqrt(light));
    vec3 power = s * (s * (s * (s * (0.349332273 - s * 0.0879411995) - 0.645795763) + 1.29203117) + 0.152857363) - 0.0604839064;
    return mix(power, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}

// The power is a polynomial in t = 1 - v, fitted in the same way over [0.04045, 1]: encoded again it is within 1.5e-5 of v.
vec3 srgb_decode(vec3 encoded) {
    vec3 value = srgb_range(encoded);
    vec3 t = 1.0 - value;
    vec3 power = 1.0 - t * (2.27352373 - t * (1.49057426 - t * (0.101704619 + t * (0.218940289 - t * (0.188001505 - t * 0.0835342073)))));
    return mix(power, value * (1.0 / 12.92), lessThanEqual(value, vec3(0.04045)));
}
#endif
