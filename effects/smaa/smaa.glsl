// SPDX-License-Identifier: MIT
#part edges edges_depth
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

// Does what differs here go on to differ the same way on one of the sides? Then it is smooth already: a soft shadow, or an
// edge that was drawn with more samples than one.
const float smaa_slope = 0.75;
bool smaa_is_slope(vec3 before, vec3 step, vec3 behind) {
    return max(dot(before, step), dot(step, behind)) >= smaa_slope * dot(step, step);
}

vec4 smaa_detected(ivec2 texel, vec2 threshold) {
    ivec2 limit = size(smaa_picture) - 1, before = max(texel - 1, 0), behind = min(texel + 1, limit);
    ivec2 further = max(texel - 2, 0);
    vec3 own = smaa_seen(texel), left = smaa_seen(ivec2(before.x, texel.y)), top = smaa_seen(ivec2(texel.x, before.y));
    vec2 apart = vec2(smaa_difference(own, left), smaa_difference(own, top));
    bvec2 is_edge = greaterThanEqual(apart, threshold);
    if (!any(is_edge)) return vec4(0.0, 0.0, 0.0, 1.0);
    vec3 right = smaa_seen(ivec2(behind.x, texel.y)), bottom = smaa_seen(ivec2(texel.x, behind.y));
    vec3 further_left = smaa_seen(ivec2(further.x, texel.y)), further_top = smaa_seen(ivec2(texel.x, further.y));
    float most = max(max(apart.x, apart.y), max(max(smaa_difference(own, right), smaa_difference(own, bottom)),
                                                max(smaa_difference(left, further_left), smaa_difference(top, further_top))));
    bvec2 is_seen = greaterThanEqual(apart * smaa_parameters().contrast, vec2(most));
    bvec2 is_slope = bvec2(smaa_is_slope(left - further_left, own - left, right - own),
                           smaa_is_slope(top - further_top, own - top, bottom - own));
    return vec4(vec2(is_edge) * vec2(is_seen) * (1.0 - vec2(is_slope)), 0.0, 1.0);
}

#part edges
// Encoded or display_linear. Which pixels differ from the one to the left (red) and the one above (green).

vec4 shade(Pixel pixel) { return smaa_detected(pixel.texel, vec2(smaa_parameters().threshold)); }

#part edges_depth
// smaa.glsl#edges, where the frame's depth says how much makes an edge: less where it jumps, more elsewhere. custom[0] and
// custom[1].x are the constants of the depth.
#include "shared/planar_distance.glsl"

// By so much of the larger one inverse distances of two things differ.
const float smaa_depth_jump = 0.05;

float smaa_inverse_distance(ivec2 texel) {
    return 1.0 / max(planar_distance(load(smaa_depth, texel).r, custom[0], custom[1].x), 1e-4);
}

vec4 shade(Pixel pixel) {
    Smaa parameters = smaa_parameters();
    ivec2 texel = pixel.texel, before = max(texel - 1, 0);
    float own = smaa_inverse_distance(texel);
    vec2 beside = vec2(smaa_inverse_distance(ivec2(before.x, texel.y)), smaa_inverse_distance(ivec2(texel.x, before.y)));
    bvec2 is_jump = greaterThan(abs(own - beside), smaa_depth_jump * max(vec2(own), beside));
    vec2 scale = mix(vec2(1.0 + parameters.predication), vec2(1.0 - 0.5 * parameters.predication), is_jump);
    return smaa_detected(texel, parameters.threshold * scale);
}

#part weights
#ifndef SMAA_LINE
#define SMAA_LINE
// Areas between an edge and a line over it, whose heights at a pixel's sides are `a` and `b`, and 1 / (b - a) is `run`: of the
// pixel itself below 0, of the one across above.
vec2 smaa_areas(float a, float b, float run) {
    vec2 p = max(vec2(-a, a), 0.0), q = max(vec2(-b, b), 0.0);
    return (p * p - q * q) * (vec2(0.5, -0.5) * run);
}

// The same of a pixel `before` others on a step of `length` pixels, whose line rises toward the side across (1) or falls
// (-1): as steep as it and the steps beside it are together, through the mean of their middles.
vec2 smaa_straight(float side, float before, float length, vec2 beside) {
    float run = side / 3.0 * (beside.x + length + beside.y), rise = 1.0 / run;
    float from = before - 0.5 * length + (beside.x - beside.y) / 6.0;
    return smaa_areas(from * rise, from * rise + rise, run);
}

// The same where both ends bend to heights, or not at all: from each end to the edge's middle.
vec2 smaa_bent(float from_height, float to_height, float before, float length) {
    float from = before / length, to = (before + 1.0) / length;
    vec4 high = max(vec4(1.0 - 2.0 * from, 2.0 * to - 1.0, 1.0 - 2.0 * to, 2.0 * from - 1.0), 0.0);
    vec2 integral = (high.xy * high.xy - high.zw * high.zw) * (0.25 * length);
    float area = dot(vec2(from_height, to_height), integral);
    return max(vec2(-area, area), 0.0);
}
#endif

#part weights
// Stairs of one pixel a step, which stand for lines between slopes of a half and two.

// Steps, a side each, that make a diagonal: a corner has two, a step of two pixels beside one has three.
const float smaa_least_diagonal = 5.0;

// A pixel of the lower side of a stair: has it an edge at the side that the stair rises from, and one at the top? Of a
// stair that falls that side is the left one of the next pixel.
bvec2 smaa_stair(ivec2 texel, bool is_rising) {
    vec2 edges = load_clamped(smaa_edges, texel).rg;
    if (!is_rising) edges.r = load_clamped(smaa_edges, texel + ivec2(1, 0)).r;
    return greaterThan(edges, vec2(0.5));
}

// How many columns the stair goes on for, the sides beyond them, and how far from the last level the line ends that it
// stands for: in the middle of the first step of two pixels, level (0) or upright (1), else (0.5) in that of the last side.
struct SmaaArm {
    int columns;
    float sides, end;
};

SmaaArm smaa_arm_up(ivec2 texel, ivec2 ahead, bool is_rising, int steps) {
    int columns = 0;
    ivec2 at = texel + ahead;
    bvec2 stair = smaa_stair(at, is_rising);
    while (all(stair) && columns < steps) {
        ++columns;
        at += ahead;
        stair = smaa_stair(at, is_rising);
    }
    if (columns == steps) return SmaaArm(columns, 0.0, 0.5);
    bvec2 beyond = smaa_stair(at - ivec2(0, stair.x ? 1 : -1), is_rising);
    if (stair.x) return SmaaArm(columns, 1.0, beyond.x ? 1.0 : 0.5);
    return SmaaArm(columns, 0.0, beyond.y ? 0.0 : 0.5);
}

SmaaArm smaa_arm_down(ivec2 texel, ivec2 ahead, bool is_rising, int steps) {
    int columns = 0;
    ivec2 at = texel;
    bvec2 stair = smaa_stair(at, is_rising), next = smaa_stair(at - ahead, is_rising);
    while (stair.x && next.y && columns < steps) {
        ++columns;
        at -= ahead;
        stair = next;
        next = smaa_stair(at - ahead, is_rising);
    }
    if (columns == steps) return SmaaArm(columns, 0.0, 0.5);
    bvec2 beyond = smaa_stair(at + (stair.x ? ivec2(0, 1) : ivec2(-ahead.x, 0)), is_rising);
    if (stair.x) return SmaaArm(columns, 1.0, beyond.x ? 1.0 : 0.5);
    return SmaaArm(columns, 0.0, beyond.y ? 0.0 : 0.5);
}

// Is the pixel's top a step of a diagonal, or of one that falls alone? Then `areas` are what it takes, and what is taken
// of it.
bool smaa_diagonal(ivec2 texel, int steps, bool has_to_fall, inout vec2 areas) {
    SmaaArm up = smaa_arm_up(texel, ivec2(1, -1), true, steps), down = smaa_arm_down(texel, ivec2(1, -1), true, steps);
    SmaaArm up_back = smaa_arm_up(texel, ivec2(-1, -1), false, steps);
    SmaaArm down_back = smaa_arm_down(texel, ivec2(-1, -1), false, steps);
    float sides = 2.0 * float(up.columns + down.columns) + up.sides + down.sides;
    float sides_back = 2.0 * float(up_back.columns + down_back.columns) + up_back.sides + down_back.sides;
    if (sides < sides_back) {
        up = up_back;
        down = down_back;
        sides = sides_back;
    } else if (has_to_fall) {
        return false;
    }
    if (sides + 1.0 < smaa_least_diagonal) return false;
    vec2 ends = vec2(up.end, down.end);
    // Level at one end and upright at the other: a curve, of which the stair is the part of slope 1.
    if (ends.x + ends.y == 1.0) ends = vec2(0.5);
    float columns = float(up.columns + down.columns), slope = (columns + ends.x + ends.y) / (columns + 1.0);
    float at = float(down.columns) * (slope - 1.0) - ends.y;
    areas = smaa_areas(at, at + slope, 1.0 / slope);
    return true;
}

#part weights
// What a pixel takes of the one above (red), that one of it (green), and the same of the one to the left (blue, alpha).
// Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012, sections 4.1 to 4.3: but areas under
// lines are integrated and not looked up, and so is where a search ended; and the lengths of the steps beside it tell where
// in a step its line lies.

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

// Of a pixel behind a crossing (8), the next (2), and the two of the row against `across` (4 and 1).
ivec2 smaa_beyond(vec2 at, vec2 onward, vec2 across, bool is_upright) {
    return ivec2(smaa_pair((at + 0.2 * onward - across / 3.0) / vec2(size(smaa_edges)), is_upright) + 0.5);
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
        ivec2 first = smaa_beyond(row, onward, across, is_upright);
        ivec2 second = smaa_beyond(is_both ? own : row + 2.0 * onward, onward, across, is_upright);
        // A line a pixel wide has an edge between both pixels that are crossed: that is a step of it, and no corner.
        ivec2 of_own = is_both ? second : first;
        end.is_corner = bvec2(end.crosses.x && (of_own.x & 8) != 0 && (of_own.y & 8) == 0,
                              end.crosses.y && (first.x & 8) != 0 && (first.y & 4) == 0);
        if (!is_both)
            end.next = (first.x & 2) != 0 ? 1.0 : (second.x & 8) != 0 ? 2.0 : (second.x & 2) != 0 ? 3.0 : smaa_unseen;
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

#part end
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
