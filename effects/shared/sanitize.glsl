// SPDX-License-Identifier: MIT
#ifndef SHARED_SANITIZE_GLSL
#define SHARED_SANITIZE_GLSL
// What filters do with numbers that would spread over everything they touch: NaN becomes 0, and the rest stays within the
// finite range of half precision. It tests bits, because GLSL does not promise that isnan() finds a NaN.

vec4 sanitize(vec4 value) {
    uvec4 magnitude = floatBitsToUint(value) & 0x7fffffffu;
    vec4 number = mix(value, vec4(0.0), greaterThan(magnitude, uvec4(0x7f800000u)));
    return clamp(number, -65504.0, 65504.0);
}

// Of light, which is not negative: that becomes 0, too. All shaders are compiled so that a clamp takes NaN to its lower end.
vec3 sanitize_light(vec3 value) { return clamp(value, 0.0, 65504.0); }

// Is a sum free of NaN and infinity? Then so was all that was summed, and a filter that asks once need not ask at every
// tap.
bool is_finite(vec3 value) {
    return all(notEqual(floatBitsToUint(value) & 0x7f800000u, uvec3(0x7f800000u)));
}

#endif
