// SPDX-License-Identifier: MIT
// Encoded or display_linear. Each pixel takes its part of the light of those beside it, across the edges that matter more there: those to
// its sides, or those above and below. Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012,
// section 4.4; but that both parts count, which a thin line has on either side.
#include "shared/sanitize.glsl"

vec4 smaa(Pixel pixel, Smaa parameters) {
    ivec2 texel = pixel.texel, limit = size(picture) - 1, behind = texel + 1;
    vec4 own = load(picture, texel), weights = load(smaa_weights, texel);
    float below = behind.y > limit.y ? 0.0 : load(smaa_weights, ivec2(texel.x, behind.y)).g;
    float right = behind.x > limit.x ? 0.0 : load(smaa_weights, ivec2(behind.x, texel.y)).a;
    vec2 upright = vec2(weights.r, below), level = vec2(weights.b, right);
    bool is_level = max(level.x, level.y) > max(upright.x, upright.y);
    vec2 parts = is_level ? level : upright;
    float sum = parts.x + parts.y;
    if (!(sum > 0.0)) return own;
    parts /= max(sum, 1.0);
    ivec2 along = is_level ? ivec2(1, 0) : ivec2(0, 1);
    vec4 from = smaa_light(sanitize(own));
    vec4 before = smaa_light(sanitize(load(picture, max(texel - along, 0))));
    vec4 after = smaa_light(sanitize(load(picture, min(texel + along, limit))));
    return smaa_coded(from + parts.x * (before - from) + parts.y * (after - from));
}
