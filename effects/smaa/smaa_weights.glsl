// SPDX-License-Identifier: MIT
// What a pixel takes of the one above (red), that one of it (green), and the same of the one to the left (blue, alpha).
// Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012, sections 4.1 to 4.3: but areas under
// lines are integrated and not looked up, and so is where a search ended; and the lengths of the steps beside it tell where
// in a step its line lies.
#include "smaa_diagonal.glsl"
#include "smaa_line.glsl"

// How far a line goes on to one side, whether something crosses it there on the pixel's own side and across (then in
// whole numbers), whether that goes on for another pixel, which makes a corner, and the length of the next step up to 3.
const float smaa_unseen = 1000.0;
struct SmaaEnd {
    float distance;
    bvec2 crosses, is_corner;
    float next;
};

// Of a pixel and the next one what crosses and what goes along. One tap between four pixels, `at` in parts of the image, tells
// their edges apart, since they weigh 8, 4 (across), 2 and 1 (the next) of 15.
vec2 smaa_pair(vec2 at, bool is_upright) {
    vec2 edges = sample_linear(smaa_edges, at).rg * 15.0;
    return is_upright ? edges.gr : edges.rg;
}

// What crosses the row at a pixel (2) and at the next (1), by one tap between them.
int smaa_crossings(vec2 first, vec2 onward, bool is_upright) {
    vec2 edges = sample_linear(smaa_edges, (first + onward / 3.0) / vec2(size(smaa_edges))).rg;
    return int((is_upright ? edges.g : edges.r) * 3.0 + 0.5);
}

// A search, pair of pixels after pair. `middle` is that of the pixel, `onward` leads from it to the next, `across` to the other
// side of the edge.
SmaaEnd smaa_end(vec2 middle, vec2 onward, vec2 across, bool is_upright, bool is_back, float pairs) {
    vec2 texel = 1.0 / vec2(size(smaa_edges));
    // What crosses the line lies before a pixel on the way back: its own is the first to be seen.
    vec2 from = (middle + (is_back ? 0.2 : 1.2) * onward + across / 3.0) * texel;
    vec2 onward_pair = 2.0 * onward * texel, edges = smaa_pair(from, is_upright);
    float pair = 0.0;
    while (edges.x < 0.5 && (int(edges.y + 0.5) & 10) == 10 && pair < pairs) {
        pair += 1.0;
        edges = smaa_pair(from + pair * onward_pair, is_upright);
    }
    ivec2 seen = ivec2(edges + 0.5);
    SmaaEnd end = SmaaEnd(2.0 * pair, bvec2(false), bvec2(false), smaa_unseen);
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
        vec2 own = crossed - across, other = crossed + 2.0 * across, row = end.crosses.y ? other : own;
        bool is_both = all(end.crosses);
        int first = smaa_crossings(row, onward, is_upright);
        int second = smaa_crossings(is_both ? own : row + 2.0 * onward, onward, is_upright);
        int of_own = is_both ? second : first;
        end.is_corner = bvec2(end.crosses.x && (of_own & 2) != 0, end.crosses.y && (first & 2) != 0);
        if (!is_both) end.next = (first & 1) != 0 ? 1.0 : second > 1 ? 2.0 : second == 1 ? 3.0 : smaa_unseen;
    }
    return end;
}

float smaa_height(bvec2 crosses) { return 0.5 * (float(crosses.y) - float(crosses.x)); }

// What the pixel takes, and what is taken of it.
vec2 smaa_orthogonal(ivec2 texel, bool is_upright, float pairs) {
    vec2 middle = vec2(texel) + 0.5, onward = is_upright ? vec2(0.0, 1.0) : vec2(1.0, 0.0), across = -onward.yx;
    SmaaEnd first = smaa_end(middle, -onward, across, is_upright, true, pairs);
    SmaaEnd second = smaa_end(middle, onward, across, is_upright, false, pairs);
    float from_height = smaa_height(first.crosses), to_height = smaa_height(second.crosses);
    // Where something crosses on both sides, the line may go either way: opposite to the other end, if that bends.
    if (all(first.crosses)) from_height = -to_height;
    if (all(second.crosses)) to_height = -from_height;
    float length = first.distance + second.distance + 1.0;
    vec2 areas;
    if (from_height * to_height < 0.0) {
        vec2 beside = min(vec2(first.next, second.next), max(length, 4.0));
        // Steps of one line differ by a pixel at most.
        float apart = max(max(beside.x, beside.y), length) - min(min(beside.x, beside.y), length);
        if (apart > 1.0 || any(first.is_corner) || any(second.is_corner)) beside = vec2(length);
        areas = smaa_straight(2.0 * to_height, first.distance, length, beside);
    } else {
        areas = smaa_bent(from_height, to_height, first.distance, length);
    }

    // What an edge takes off a corner is the nearer end's matter.
    vec2 nearer = vec2(lessThanEqual(vec2(first.distance, second.distance), vec2(second.distance, first.distance)));
    nearer *= (1.0 - smaa_parameters().corner_rounding) / (nearer.x + nearer.y);
    return areas * (1.0 - nearer.x * vec2(first.is_corner) - nearer.y * vec2(second.is_corner));
}

vec4 shade(Pixel pixel) {
    uint quality = smaa_parameters().quality;
    vec2 edges = load(smaa_edges, pixel.texel).rg;
    vec4 weights = vec4(0.0);
    float pairs = float(4u << quality);
    int steps = quality < Smaa_quality_high ? 0 : quality == Smaa_quality_high ? 8 : 16;
    bool is_diagonal = false, has_top = edges.g > 0.5;
    if (steps > 0) {
        // The side of a stair that rises is its own pixel's, that of one that falls the next pixel's.
        ivec2 before = pixel.texel - ivec2(1, 0);
        bool is_beside = !has_top && edges.r > 0.5 && load_clamped(smaa_edges, before).g > 0.5;
        if (has_top || is_beside)
            is_diagonal = smaa_diagonal(is_beside ? before : pixel.texel, steps, is_beside, weights.rg);
    }
    if (!has_top) weights.rg = vec2(0.0);
    if (has_top && !is_diagonal) weights.rg = smaa_orthogonal(pixel.texel, false, pairs);
    // A diagonal is smoothed from above and below alone.
    if (edges.r > 0.5 && !is_diagonal) weights.ba = smaa_orthogonal(pixel.texel, true, pairs);
    return weights;
}
