// SPDX-License-Identifier: MIT
// Nearness, one over the planar distance, with the visibility in its last ten bits; beside it the surface's slope from one
// texel to the next, as a share of the nearness: two halves of less than 1, whose unused bit makes an ordinary number of
// them, which no device flushes to zero. The last three bits of both say how much of the noise's tile the surface covers, in
// quarters of a texel less one.

const uint ssao_ordinary = 0x40000000u, ssao_cover = 0x70007u;

vec4 ssao_visibility(vec4 packed) { return vec4(floatBitsToInt(packed) & 1023); }

// The middle of what it may have been.
float ssao_near(float packed) { return intBitsToFloat((floatBitsToInt(packed) & ~1023) | 512); }

float ssao_with(float near, float visibility) {
    return intBitsToFloat((floatBitsToInt(near) & ~1023) | int(visibility + 0.5));
}

// `covered`: of the tile's 16 texels, at least the one here.
float ssao_pack_slope(vec2 slope, float covered) {
    uint halves = packHalf2x16(clamp(slope, vec2(-0.999), vec2(0.999))) & ~ssao_cover;
    uint quarters = uint(max(covered * 4.0 - 0.5, 0.0));
    return uintBitsToFloat(halves | ssao_ordinary | (quarters & 7u) | (quarters & 56u) << 13);
}

vec2 ssao_slope_of(float packed) { return unpackHalf2x16(floatBitsToUint(packed) & ~(ssao_ordinary | ssao_cover)); }

// In quarters of a texel.
vec4 ssao_covered(vec4 packed) {
    uvec4 bits = floatBitsToUint(packed);
    return vec4((bits & 7u) | (bits >> 13 & 56u)) + 1.0;
}
