// SPDX-License-Identifier: MIT
// From light to what is averaged, and back. `unit` is the light that is shown as half of white: the inverse of the exposure.
#include "shared/sanitize.glsl"

vec3 taa_toned(vec3 light, float unit) { return light / (unit + max(light.r, max(light.g, light.b))); }

// YCoCg.
vec3 taa_opponent(vec3 toned) {
    float green = 0.5 * toned.g, both = 0.25 * (toned.r + toned.b);
    return vec3(both + green, 0.5 * (toned.r - toned.b), green - both);
}

vec3 taa_colors(vec3 opponent) {
    float both = opponent.x - opponent.z;
    return max(vec3(both + opponent.y, opponent.x + opponent.z, both - opponent.y), vec3(0.0));
}

vec3 taa_light(vec3 toned, float unit) {
    // As bright as half floats can be.
    return min(toned * unit / max(1.0 - max(toned.r, max(toned.g, toned.b)), 1e-7), vec3(65504.0));
}

// Stops of the unit, in 32nds, which the history holds as codes of 16 bits.
float taa_stops_of(float exposure) { return floor(0.5 - 32.0 * log2(clamp(exposure, 1e-6, 1e6))) / 32.0; }
float taa_packed_stops(float stops) { return (stops * 32.0 + 1024.0) / 65535.0; }
float taa_unpacked_stops(float packed) { return floor(packed * 65535.0 - 1023.5) / 32.0; }

// The history is stored in 16 bits. Rounding to the nearest would swallow small steps, and truncation would darken the
// picture frame by frame. So a value is rounded up as often as the part that it loses is large. Noise by J. Jimenez,
// "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.
float taa_dither(ivec2 texel, float frame) {
    vec2 place = vec2(texel) + 5.588238 * frame;
    return fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
}
vec3 taa_rounded(vec3 value, float dither, bool is_of_codes) {
    vec3 part = fract(vec3(0.0, 1.0 / 3.0, 2.0 / 3.0) + dither);
    if (is_of_codes) return floor(value * 65535.0 + part) / 65535.0;
    // A half has 13 bits of mantissa less.
    return uintBitsToFloat((floatBitsToUint(value) + uvec3(part * 8192.0)) & 0xffffe000u);
}

// Frames up to 128 and a deviation, as roots of their share in 8 bits each.
vec2 taa_packed(vec2 kept, float dither) {
    return floor(sqrt(clamp(kept / vec2(128.0, 1.0), 0.0, 1.0)) * 255.0 + vec2(dither, fract(dither + 0.5))) / 255.0;
}
vec2 taa_unpacked(vec2 packed) { return packed * packed * vec2(128.0, 1.0); }
