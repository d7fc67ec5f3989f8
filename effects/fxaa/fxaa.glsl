// SPDX-License-Identifier: MIT
// Encoded or display_linear; luma is that of the values as they are. Timothy Lottes, "FXAA", 2009, and the quality form of
// version 3.11, 2011.
#include "shared/sanitize.glsl"

float fxaa_luma(vec4 color) { return dot(color.rgb, vec3(0.299, 0.587, 0.114)); }

// From the pixel seen in this round to that of the next: pairs at first, a leap at last.
int fxaa_step(int round, int last) {
    int leap = last == 12 ? 8 : 12;
    return round < last - 2 ? 2 : round < last - 1 ? 4 : leap;
}

// All reads are in one loop, four pixels a round, because every driver ends a loop early and some do not skip the rest of
// a branch: first the neighbours, then the corners, and from there both ways along the edge.
vec4 fxaa(Pixel pixel, Fxaa parameters) {
    uint quality = parameters.quality;
    int last = quality == Fxaa_quality_low ? 5 : quality == Fxaa_quality_medium ? 8 : 12;
    vec4 own = load_clamped(picture, pixel.texel);
    float m = fxaa_luma(own), range = 0.0, blur = 0.0, edge = 0.0, enough = 0.0;
    ivec2 a = ivec2(0, -1), b = ivec2(0, 1), c = ivec2(-1, 0), d = ivec2(1, 0), along = ivec2(0), across = ivec2(0);
    vec4 up = own, down = own, left = own, right = own, beside = vec4(0.0);
    bool is_horizontal = false, is_first = false, goes_on = false;
    ivec2 at = ivec2(1), seen = ivec2(0);
    vec2 found = vec2(0.0);
    int round = 0;
    do {
        vec4 color_a = load_clamped(picture, pixel.texel + a), color_b = load_clamped(picture, pixel.texel + b);
        vec4 color_c = load_clamped(picture, pixel.texel + c), color_d = load_clamped(picture, pixel.texel + d);
        vec4 luma = vec4(fxaa_luma(color_a), fxaa_luma(color_b), fxaa_luma(color_c), fxaa_luma(color_d));
        vec2 sums = luma.xz + luma.yw;
        if (round == 0) {
            up = color_a, down = color_b, left = color_c, right = color_d, beside = luma;
            float highest = max(max(max(luma.x, luma.y), max(luma.z, luma.w)), m);
            range = highest - min(min(min(luma.x, luma.y), min(luma.z, luma.w)), m);
            goes_on = range >= max(parameters.edge_threshold_min, highest * parameters.edge_threshold);
            a = ivec2(-1, -1), b = ivec2(1, -1), c = ivec2(-1, 1), d = ivec2(1, 1);
        } else if (round == 1) {
            float mean = (2.0 * dot(beside, vec4(1.0)) + dot(luma, vec4(1.0))) / 12.0;
            float lone = smoothstep(0.0, 1.0, abs(mean - m) / range);
            blur = lone * lone * parameters.subpixel;
            vec2 bend = 2.0 * abs(vec2(beside.x + beside.y, beside.z + beside.w) - 2.0 * m) +
                        abs(vec2(luma.x + luma.z - 2.0 * beside.z, luma.x + luma.y - 2.0 * beside.x)) +
                        abs(vec2(luma.y + luma.w - 2.0 * beside.w, luma.z + luma.w - 2.0 * beside.y));
            // Often both are equal, by the sum's own symmetry: rounding shall not decide then.
            is_horizontal = bend.x >= bend.y - 1.0 / 1024.0;
            // The edge lies between this pixel and the one across that differs more.
            vec2 sides = is_horizontal ? beside.xy : beside.zw;
            is_first = abs(sides.x - m) >= abs(sides.y - m);
            float other = is_first ? sides.x : sides.y;
            edge = 0.5 * (m + other);
            enough = 0.25 * abs(other - m);
            along = is_horizontal ? ivec2(1, 0) : ivec2(0, 1);
            across = (ivec2(1) - along) * (is_first ? -1 : 1);
            // The first pixels of the search are those that were read.
            sums = is_horizontal ? beside.zw + (is_first ? luma.xy : luma.zw)
                                 : beside.xy + (is_first ? luma.xz : luma.yw);
        }
        if (round > 0) {
            found = 0.5 * sums - edge;
            bvec2 is_open = lessThan(abs(found), vec2(enough));
            goes_on = round < last && any(is_open);
            seen = mix(seen, at, is_open);
            if (goes_on) at = mix(at, at + fxaa_step(round, last), is_open);
            a = -along * at.x;
            b = a + across;
            c = along * at.y;
            d = c + across;
        }
        ++round;
    } while (goes_on);
    if (round == 1) return own;

    // The end is one of the pixels behind the last that is none: it is taken from their middle.
    vec2 away = 0.5 * vec2(seen + 1 + at);
    float end = away.x < away.y ? found.x : found.y;
    // At an end of the own side the edge goes on as it is; at one of the other side the pixel is part of the step.
    bool is_step = (end < 0.0) != (m - edge < 0.0);
    float shift = max(is_step ? 0.5 - min(away.x, away.y) / (away.x + away.y) : 0.0, blur);
    if (!(shift > 0.0)) return own;
    vec4 neighbour = is_horizontal ? (is_first ? up : down) : (is_first ? left : right);
    return vec4(mix(sanitize(own).rgb, sanitize(neighbour).rgb, shift), own.a);
}
