// SPDX-License-Identifier: MIT
// How far from uv green is read (xy), and red further than it, and blue less (zw), in uv. frame = (the picture's half
// size where its half diagonal is 1, scale, ...), k = (coefficients of the squared distance and of its square, what is
// added to the first for red, half the diagonal in pixels).

vec4 lens_distortion_way(vec2 uv, vec4 frame, vec4 k) {
    vec2 from_centre = uv - 0.5;
    vec2 place = 2.0 * from_centre * frame.xy;
    float squared = dot(place, place);
    float green = frame.z * (1.0 + squared * (k.x + squared * k.y)) - 1.0;
    return vec4(from_centre * green, from_centre * (frame.z * squared * k.z));
}
