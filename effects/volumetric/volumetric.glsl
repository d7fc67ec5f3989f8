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
    ivec2 base = pixel.texel >> 1, last = size(volumetric_shafts) - 1;
    vec2 part = vec2(pixel.texel & 1) * 0.5;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 bilinear = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        vec4 tap = load(volumetric_shafts, min(base + ivec2(i & 1, i >> 1), last));
        float unlike = 0.01 + abs(tap.a * inverse - 1.0), reach = max(min(tap.a, parameters.max_distance), 1e-3);
        float weight = (bilinear.x * bilinear.y + 1e-3) / (unlike * reach);
        // What is thinner than a half-size pixel has nobody like it; the light before it is then estimated by length.
        sum += tap.rgb * (weight * min(planar, reach));
        weights += weight * reach;
    }
    return vec4(color.rgb + sum / weights, color.a);
}
