// SPDX-License-Identifier: MIT
// The mean over the tile of the noise, of those pixels that lie in the surface here. The tile reaches from two pixels before this one to one after; the upsampling makes up for the half pixel.

// How the surface goes on: the lesser of both sides' slopes, and none at a ridge. Continuous in all three distances.
float ssao_slope(float before, float here, float after) {
    float a = here - before, b = after - here;
    return max(min(a, b), 0.0) + min(max(a, b), 0.0);
}

vec4 ssao_weight(vec4 distance, vec4 expected, float tolerance) {
    return clamp(2.0 - abs(distance - expected) * tolerance, 0.0, 1.0);
}

vec4 ssao_visibility(vec4 packed) {
    return vec4(floatBitsToInt(packed) & 1023);
}

vec4 shade(Pixel pixel) {
    vec2 texel = 1.0 / vec2(pixel.size);
    vec2 low = (vec2(pixel.texel) - 1.0) * texel, high = (vec2(pixel.texel) + 1.0) * texel;
    // The low bits do not matter to distances.
    vec4 packed_00 = gather_red(ssao_raw, low), packed_10 = gather_red(ssao_raw, vec2(high.x, low.y));
    vec4 packed_01 = gather_red(ssao_raw, vec2(low.x, high.y)), packed_11 = gather_red(ssao_raw, high);
    // Order of a gather: (0,1), (1,1), (1,0), (0,0).
    float own = packed_11.w;
    float x = ssao_slope(packed_01.z, own, packed_11.z), y = ssao_slope(packed_10.x, own, packed_11.x);
    // A surface may bend by a tenth of its slope and by 1 % of the distance; at twice that it is another one.
    float tolerance = 1.0 / (0.01 * own + 0.1 * (abs(x) + abs(y)));
    vec4 expected = own + x * vec4(0.0, 1.0, 1.0, 0.0) + y * vec4(1.0, 1.0, 0.0, 0.0);
    vec4 weight_00 = ssao_weight(packed_00, expected - 2.0 * (x + y), tolerance);
    vec4 weight_10 = ssao_weight(packed_10, expected - 2.0 * y, tolerance);
    vec4 weight_01 = ssao_weight(packed_01, expected - 2.0 * x, tolerance);
    vec4 weight_11 = ssao_weight(packed_11, expected, tolerance);
    float sum = dot(ssao_visibility(packed_00), weight_00) + dot(ssao_visibility(packed_10), weight_10) +
                dot(ssao_visibility(packed_01), weight_01) + dot(ssao_visibility(packed_11), weight_11);
    // Its own weight is one.
    float seen = sum / dot(weight_00 + weight_10 + weight_01 + weight_11, vec4(1.0));
    return vec4(intBitsToFloat((floatBitsToInt(own) & ~1023) | int(seen + 0.5)), 0.0, 0.0, 0.0);
}
