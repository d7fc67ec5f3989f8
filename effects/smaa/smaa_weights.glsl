// SPDX-License-Identifier: MIT
// What a pixel takes of the one above (red), that one of it (green), and the same of the one to the left (blue, alpha).
// Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012, sections 4.1 to 4.3: but areas under
// lines are integrated and not looked up, and so is where a search ended.
#include "smaa_diagonal.glsl"
#include "smaa_line.glsl"

// How far a line goes on to one side, whether something crosses it there on the pixel's own side and across (then in
// whole numbers), and whether that goes on for another pixel, which makes a corner.
struct SmaaEnd {
    float distance;
    bvec2 crosses, is_corner;
};

// A search, pair of pixels after pair. `near` is the middle of the first pixel, `onward` leads from it to the next, `across`
// to the other side of the edge. One tap between four pixels tells their edges apart, since they weigh 8, 4 (across), 2
// and 1 (the next) of 15.
ivec2 smaa_pair(vec2 near, vec2 onward, vec2 across, bool is_upright) {
    vec2 edges = sample_linear(smaa_edges, (near + 0.2 * onward + across / 3.0) / vec2(size(smaa_edges))).rg;
    return ivec2((is_upright ? edges.gr : edges.rg) * 15.0 + 0.5);  // what crosses, and what goes along
}

SmaaEnd smaa_end(vec2 middle, vec2 onward, vec2 across, bool is_upright, bool is_back, int pairs) {
    // What crosses the line lies before a pixel on the way back: its own is the first to be seen.
    vec2 near = is_back ? middle : middle + onward;
    ivec2 seen = smaa_pair(near, onward, across, is_upright);
    int pair = 0;
    while (seen.x == 0 && (seen.y & 10) == 10 && pair < pairs) {
        ++pair;
        near += 2.0 * onward;
        seen = smaa_pair(near, onward, across, is_upright);
    }
    SmaaEnd end = SmaaEnd(2.0 * float(pair), bvec2(false), bvec2(false));
    bool is_open = pair == pairs;
    if (is_back) {
        bool is_near = (seen.x & 12) != 0 || (seen.y & 2) == 0;
        if (is_open || (seen.y & 8) == 0) {
            end.distance -= 1.0;
        } else {
            end.distance += is_near ? 0.0 : 1.0;
            int crossing = is_near ? seen.x >> 2 : seen.x;
            end.crosses = bvec2((crossing & 2) != 0, (crossing & 1) != 0);
        }
    } else if (!is_open) {
        bool is_near = (seen.x & 12) != 0 || (seen.y & 8) == 0;
        end.distance += is_near ? 0.0 : 1.0;
        int crossing = is_near ? seen.x >> 2 : seen.x;
        end.crosses = bvec2((crossing & 2) != 0, (crossing & 1) != 0);
    }
    if (any(end.crosses)) {
        vec2 crossed = middle + onward * (end.distance + (is_back ? 0.0 : 1.0));
        vec4 beside = vec4(load_clamped(smaa_edges, ivec2(floor(crossed - across))).rg,
                           load_clamped(smaa_edges, ivec2(floor(crossed + 2.0 * across))).rg);
        end.is_corner = greaterThan(is_upright ? beside.yw : beside.xz, vec2(0.5));
    }
    return end;
}

float smaa_height(bvec2 crosses) { return 0.5 * (float(crosses.y) - float(crosses.x)); }

// What the pixel takes, and what is taken of it.
vec2 smaa_orthogonal(ivec2 texel, bool is_upright, int pairs) {
    vec2 middle = vec2(texel) + 0.5, onward = is_upright ? vec2(0.0, 1.0) : vec2(1.0, 0.0), across = -onward.yx;
    SmaaEnd first = smaa_end(middle, -onward, across, is_upright, true, pairs);
    SmaaEnd second = smaa_end(middle, onward, across, is_upright, false, pairs);
    float from_height = smaa_height(first.crosses), to_height = smaa_height(second.crosses);
    // Where something crosses on both sides, the line may go either way: opposite to the other end, if that bends.
    if (all(first.crosses)) from_height = -to_height;
    if (all(second.crosses)) to_height = -from_height;
    vec2 areas = smaa_bent(from_height, to_height, first.distance, first.distance + second.distance + 1.0);

    // What an edge takes off a corner is the nearer end's matter.
    vec2 nearer = vec2(lessThanEqual(vec2(first.distance, second.distance), vec2(second.distance, first.distance)));
    nearer *= (1.0 - smaa_parameters().corner_rounding) / (nearer.x + nearer.y);
    return areas * (1.0 - nearer.x * vec2(first.is_corner) - nearer.y * vec2(second.is_corner));
}

vec4 shade(Pixel pixel) {
    uint quality = smaa_parameters().quality;
    vec2 edges = load(smaa_edges, pixel.texel).rg;
    vec4 weights = vec4(0.0);
    bool is_diagonal = false;
    int pairs = 4 << quality, steps = quality < Smaa_quality_high ? 0 : quality == Smaa_quality_high ? 8 : 16;
    if (edges.g > 0.5) {
        if (steps > 0) is_diagonal = smaa_diagonal(pixel.texel, steps, weights.rg);
        if (!is_diagonal) weights.rg = smaa_orthogonal(pixel.texel, false, pairs);
    }
    // A diagonal is smoothed from above and below alone.
    if (edges.r > 0.5 && !is_diagonal) weights.ba = smaa_orthogonal(pixel.texel, true, pairs);
    return weights;
}
