// SPDX-License-Identifier: MIT
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
