// SPDX-License-Identifier: MIT
// Visibility of the four full-size pixels of every half-size one. Of the four half-size pixels around, those count whose
// distance is like the full-size pixel's (Kopf et al., "Joint Bilateral Upsampling", 2007). ssao_depth: the host's; custom[0]
// and [1].x: the constants of planar_distance().
#include "shared/planar_distance.glsl"

// Half-size pixel i holds full-size pixel 2i, and the blur moved its middle by half a half-size pixel back: an even
// full-size pixel is half way between two, an odd one on the second. The rest is for edges, where that one is unlike.
const float ssao_rest = 0.05;

float ssao_mean(vec4 visibility, vec4 distance, float planar, vec4 bilinear) {
    // Where all are unlike, all count.
    vec4 weight = (bilinear + ssao_rest) * (clamp(2.0 - abs(distance * (40.0 / planar) - 40.0), 0.0, 1.0) + 1e-4);
    // The mean of ones shall be one, not what rounding leaves of it.
    float mean = min(dot(visibility, weight) / dot(weight, vec4(1022.998)), 1.0);
    return planar > 1e-6 && planar < 1e9 ? mean : 1.0;
}

// Order of a gather, of distances here and of visibilities in the result: (0,1), (1,1), (1,0), (0,0).
vec4 shade(Pixel pixel) {
    vec4 packed = gather_red(ssao_blurred, (vec2(pixel.texel) + 1.0) / vec2(pixel.size));
    vec4 depth = gather_red(ssao_depth, (vec2(pixel.texel) * 2.0 + 1.0) / vec2(size(ssao_depth)));
    vec4 planar = planar_distance(depth, custom[0], custom[1].x);
    vec4 visibility = vec4(floatBitsToInt(packed) & 1023);
    return vec4(ssao_mean(visibility, packed, planar.x, vec4(0.5, 0.5, 0.0, 0.0)),
                ssao_mean(visibility, packed, planar.y, vec4(0.0, 1.0, 0.0, 0.0)),
                ssao_mean(visibility, packed, planar.z, vec4(0.0, 0.5, 0.5, 0.0)),
                ssao_mean(visibility, packed, planar.w, vec4(0.25)));
}
