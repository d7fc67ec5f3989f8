// SPDX-License-Identifier: MIT
// Encoded or display_linear; luma is that of the values as they are, and pixels are mixed as light. Timothy Lottes, "FXAA", 2009, and the quality form of
// version 3.11, 2011.
#include "shared/sanitize.glsl"

// Luma in units of green's weight.
const float fxaa_green = 0.587;
float fxaa_luma(vec3 color) { return color.r * (0.299 / fxaa_green) + color.g + color.b * (0.114 / fxaa_green); }
float fxaa_luma_at(int x, int y) { return fxaa_luma(load(picture, ivec2(x, y)).rgb); }

// From the pixel seen in one round to that of the next: each in `dense` rounds, then pairs, a leap at last.
int fxaa_step(int round, int last, int dense) {
    int stride = last == 4 ? 3 : 4, leap = last == 12 ? 8 : 12;
    return round <= dense ? 1 : round < last - 2 ? 2 : round < last - 1 ? stride : leap;
}

vec4 fxaa(Pixel pixel, Fxaa parameters) {
    uint quality = parameters.quality;
    int last = quality == Fxaa_quality_low ? 4 : quality == Fxaa_quality_medium ? 8 : 12;
    int dense = quality == Fxaa_quality_ultra ? 4 : 0;
    ivec2 texel = pixel.texel, limit = size(picture) - 1, before = max(texel - 1, 0), behind = min(texel + 1, limit);
    vec4 own = load(picture, texel);
    float m = fxaa_luma(own.rgb);
    float n = fxaa_luma_at(texel.x, before.y), s = fxaa_luma_at(texel.x, behind.y);
    float w = fxaa_luma_at(before.x, texel.y), e = fxaa_luma_at(behind.x, texel.y);
    float highest = max(max(max(n, s), max(w, e)), m), range = highest - min(min(min(n, s), min(w, e)), m);
    if (!(range >= max(parameters.edge_threshold_min / fxaa_green, highest * parameters.edge_threshold))) return own;

    float nw = fxaa_luma_at(before.x, before.y), ne = fxaa_luma_at(behind.x, before.y);
    float sw = fxaa_luma_at(before.x, behind.y), se = fxaa_luma_at(behind.x, behind.y);
    float mean = (2.0 * (n + s + w + e) + (nw + ne + sw + se)) / 12.0;
    float lone = smoothstep(0.0, 1.0, abs(mean - m) / range);
    float change_down = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    float change_right = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    // Often both are equal, by the sum's own symmetry: rounding shall not decide then.
    bool is_horizontal = change_down >= change_right - 1.0 / (1024.0 * fxaa_green);
    // The edge lies between this pixel and the one across that differs more.
    float first = is_horizontal ? n : w, second = is_horizontal ? s : e;
    bool is_first = abs(first - m) >= abs(second - m);
    float other = is_first ? first : second;
    // A pair of pixels beside the edge has this sum; its end is where that differs by more than `enough`.
    float edge = m + other, enough = 0.5 * abs(other - m);
    ivec2 along = ivec2(-int(is_horizontal), int(is_horizontal) - 1);  // masks
    ivec2 across = ((is_first ? before : behind) - texel) & along.yx;
    ivec2 room = is_horizontal ? ivec2(texel.x, limit.x - texel.x) : ivec2(texel.y, limit.y - texel.y);

    // The first pairs are among the pixels that were read.
    float corner_before = is_first ? nw : is_horizontal ? sw : ne, corner_behind = is_first ? (is_horizontal ? ne : sw) : se;
    vec2 found = vec2((is_horizontal ? w : n) + corner_before, (is_horizontal ? e : s) + corner_behind) - edge;
    bvec2 is_open = lessThan(abs(found), vec2(enough));
    ivec2 seen = ivec2(is_open), at = 1 + fxaa_step(1, last, dense) * seen;
    int round = 1;
    // The condition stands at the top, so that a pixel which has left the loop keeps its values (see docs/limits.md).
    while (any(is_open) && round < last) {
        ivec2 reach = min(at, room), a = texel - (along & reach.x), b = texel + (along & reach.y);
        found = vec2(fxaa_luma(load(picture, a).rgb + load(picture, a + across).rgb),
                     fxaa_luma(load(picture, b).rgb + load(picture, b + across).rgb)) - edge;
        is_open = lessThan(abs(found), vec2(enough));
        seen = mix(seen, at, is_open);
        ++round;
        if (round < last) at = mix(at, at + fxaa_step(round, last, dense), is_open);
    }

    // The end is one of the pixels behind the last that is none: it is taken from their middle, here twice as far.
    vec2 away = vec2(seen + 1 + at);
    float end = away.x < away.y ? found.x : found.y;
    // At an end of the own side the edge goes on as it is; at one of the other side the pixel is part of the step.
    bool is_step = (end < 0.0) != (m < other);
    float shift = max(is_step ? 0.5 - min(away.x, away.y) / (away.x + away.y) : 0.0, lone * lone * parameters.subpixel);
    if (!(shift > 0.0)) return own;
    vec4 from = fxaa_light(sanitize(own)), toward = fxaa_light(sanitize(load(picture, texel + across)));
    return fxaa_coded(from + shift * (toward - from));
}
