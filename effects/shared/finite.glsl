// SPDX-License-Identifier: MIT
#ifndef SHARED_FINITE_GLSL
#define SHARED_FINITE_GLSL
// Is a sum free of NaN and infinity? Then so was all that was summed, and a filter that asks once need not ask at every
// tap. Bits are tested, as in sanitize.glsl.
bool is_finite(vec3 value) {
    return all(notEqual(floatBitsToUint(value) & 0x7f800000u, uvec3(0x7f800000u)));
}

#endif
