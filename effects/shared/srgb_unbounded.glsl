// SPDX-License-Identifier: MIT
// IEC 61966-2-1 both ways, the power going on above 1 and the line below 0: for light that is encoded only in between.
// Precise, so that lean kernels, which see both next to each other, give the bits of complete ones.
#ifndef SHARED_SRGB_UNBOUNDED
#define SHARED_SRGB_UNBOUNDED
vec3 srgb_encode_unbounded(vec3 linear) {
    precise vec3 power = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    precise vec3 line = 12.92 * linear;
    return mix(power, line, lessThanEqual(linear, vec3(0.0031308)));
}
vec3 srgb_decode_unbounded(vec3 encoded) {
    precise vec3 power = pow((max(encoded, vec3(0.04045)) + 0.055) / 1.055, vec3(2.4));
    precise vec3 line = encoded / 12.92;
    return mix(power, line, lessThanEqual(encoded, vec3(0.04045)));
}
#endif
