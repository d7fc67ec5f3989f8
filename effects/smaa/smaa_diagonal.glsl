// SPDX-License-Identifier: MIT
// Stairs of one pixel a step, which stand for lines between slopes of a half and two.
#include "smaa_line.glsl"

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
