// SPDX-License-Identifier: MIT
// From light to what is averaged, and back. `unit` is the light that is shown as white: the inverse of the exposure.
#include "shared/sanitize.glsl"

vec3 taa_toned(vec3 light, float unit) {
    vec3 t = light / (unit + max(light.r, max(light.g, light.b)));
    float green = 0.5 * t.g, both = 0.25 * (t.r + t.b);
    return vec3(both + green, 0.5 * (t.r - t.b), green - both);
}

vec3 taa_light(vec3 toned, float unit) {
    float green = toned.x - toned.z;
    vec3 t = max(vec3(green + toned.y, toned.x + toned.z, green - toned.y), vec3(0.0));
    // As bright as half floats can be.
    return min(t * unit / max(1.0 - max(t.r, max(t.g, t.b)), 1e-7), vec3(65504.0));
}

// Halves would stop at what is near, and drivers that cut off would darken: it is rounded up as often as the part that
// is lost is large. Noise by J. Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.
float taa_noise(ivec2 texel, float frame) {
    vec2 place = vec2(texel) + 5.588238 * frame;
    return fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
}
vec3 taa_rounded(vec3 value, float noise) {
    // A half has 13 bits of mantissa less.
    uvec3 steps = uvec3(fract(vec3(0.0, 1.0 / 3.0, 2.0 / 3.0) + noise) * 8192.0);
    return min(uintBitsToFloat((floatBitsToUint(value) + steps) & 0xffffe000u), vec3(65504.0));
}
