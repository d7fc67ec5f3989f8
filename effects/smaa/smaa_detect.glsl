// SPDX-License-Identifier: MIT
// Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012, section 3: edges, but for those beside
// a stronger one.

vec3 smaa_seen(ivec2 texel) {
    vec3 color = load(smaa_picture, texel).rgb;
    return smaa_parameters().detection == Smaa_detection_color ? color : vec3(dot(color, vec3(0.299, 0.587, 0.114)));
}
float smaa_difference(vec3 a, vec3 b) {
    vec3 apart = abs(a - b);
    return max(apart.r, max(apart.g, apart.b));
}

vec4 smaa_detected(ivec2 texel, vec2 threshold) {
    ivec2 limit = size(smaa_picture) - 1, before = max(texel - 1, 0), behind = min(texel + 1, limit);
    ivec2 further = max(texel - 2, 0);
    vec3 own = smaa_seen(texel), left = smaa_seen(ivec2(before.x, texel.y)), top = smaa_seen(ivec2(texel.x, before.y));
    vec2 apart = vec2(smaa_difference(own, left), smaa_difference(own, top));
    bvec2 is_edge = greaterThanEqual(apart, threshold);
    if (!any(is_edge)) return vec4(0.0, 0.0, 0.0, 1.0);
    float most = max(max(apart.x, apart.y),
                     max(max(smaa_difference(own, smaa_seen(ivec2(behind.x, texel.y))),
                             smaa_difference(own, smaa_seen(ivec2(texel.x, behind.y)))),
                         max(smaa_difference(left, smaa_seen(ivec2(further.x, texel.y))),
                             smaa_difference(top, smaa_seen(ivec2(texel.x, further.y))))));
    bvec2 is_seen = greaterThanEqual(apart * smaa_parameters().contrast, vec2(most));
    return vec4(vec2(is_edge) * vec2(is_seen), 0.0, 1.0);
}
