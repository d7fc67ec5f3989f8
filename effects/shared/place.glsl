// SPDX-License-Identifier: MIT
// Where a picture is read: uv, and how strongly a barrel bends it behind that, for red, green (and alpha) and blue.
// Barrels add up, so that maps which bend compose into one.
#ifndef SHARED_PLACE
#define SHARED_PLACE
struct Place {
    vec2 uv;
    vec3 barrel;
};

// c (1 + strength |c|^2), c the distance from the middle in uv: above 0 the corners are drawn inward, below 0 outward.
vec2 barrel(vec2 uv, float strength) {
    precise vec2 from_centre = uv - 0.5;
    return from_centre * (1.0 + strength * dot(from_centre, from_centre)) + 0.5;
}
#endif
