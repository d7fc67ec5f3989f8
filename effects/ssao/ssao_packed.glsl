// SPDX-License-Identifier: MIT
// Nearness, one over the planar distance, with the visibility in its last ten bits; beside it the surface's slope from one
// texel to the next, as a share of the nearness: two halves of less than 1, whose unused bit makes an ordinary number of
// them, which no device flushes to zero.

const uint ssao_ordinary = 0x40000000u;

vec4 ssao_visibility(vec4 packed) { return vec4(floatBitsToInt(packed) & 1023); }

// The middle of what it may have been.
float ssao_near(float packed) { return intBitsToFloat((floatBitsToInt(packed) & ~1023) | 512); }

float ssao_with(float near, float visibility) {
    return intBitsToFloat((floatBitsToInt(near) & ~1023) | int(visibility + 0.5));
}

float ssao_pack_slope(vec2 slope) {
    return uintBitsToFloat(packHalf2x16(clamp(slope, vec2(-0.999), vec2(0.999))) | ssao_ordinary);
}

vec2 ssao_slope_of(float packed) { return unpackHalf2x16(floatBitsToUint(packed) & ~ssao_ordinary); }
