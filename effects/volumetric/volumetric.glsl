// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. Adds the shafts: of the four nearest half-size pixels those count whose distance, in alpha,
// is like this pixel's. volumetric_depth: the host's; volumetric_custom(0) and (1).x: the constants of planar_distance().
#include "shared/planar_distance.glsl"

vec4 volumetric(vec4 color, Pixel pixel, Volumetric parameters) {
    float depth = load(volumetric_depth, pixel.texel).r;
    // The sky lies where half precision ends.
    float planar = clamp(planar_distance(depth, volumetric_custom(0), volumetric_custom(1).x), 1e-3, 60000.0);
    float inverse = 1.0 / planar;
    // Neutral images are of one texel, so nothing is read beyond what size() says.
    ivec2 second = pixel.texel & 1, last = size(volumetric_shafts) - 1;
    ivec2 here = min((pixel.texel >> 1) + second, last), there = min((pixel.texel >> 1) + 1 - second, last);
    vec4 taps[4];
    taps[0] = load(volumetric_shafts, here);
    if (has_quads) {
        // All pixels of a quad have the same four.
        taps[1] = from_beside(taps[0]);
        taps[2] = from_below(taps[0]);
        taps[3] = from_below(taps[1]);
    } else {
        taps[1] = load(volumetric_shafts, ivec2(there.x, here.y));
        taps[2] = load(volumetric_shafts, ivec2(here.x, there.y));
        taps[3] = load(volumetric_shafts, there);
    }
    vec2 other = 0.5 * vec2(second);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 bilinear = mix(1.0 - other, other, vec2(i & 1, i >> 1));
        vec4 tap = taps[i];
        float unlike = 0.01 + abs(tap.a * inverse - 1.0), reach = max(min(tap.a, parameters.max_distance), 1e-3);
        float weight = (bilinear.x * bilinear.y + 1e-3) / (unlike * reach);
        // What is thinner than a half-size pixel has nobody like it; the light before it is then estimated by length.
        sum += tap.rgb * (weight * min(planar, reach));
        weights += weight * reach;
    }
    return vec4(color.rgb + sum / weights, color.a);
}
