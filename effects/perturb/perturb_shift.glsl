// SPDX-License-Identifier: MIT
// How far what is seen at uv lies from there, in pixels. frame = (phases of the sines in turns, radius of the ring in
// heights of the picture, its amplitude in pixels).

float perturb_bump(float place) {
    float half_wave = cos(1.57079633 * place);
    return abs(place) < 1.0 ? half_wave * half_wave : 0.0;
}

// `sines`: of 2 pi (strength.z v + phase.x) and of 2 pi (strength.w u + phase.y).
vec2 perturb_sum(vec2 uv, vec2 sines, vec2 image, vec4 frame, vec2 size, Perturb parameters) {
    vec2 shift = parameters.strength.xy * sines;
    vec2 from_center = (uv - parameters.ring_center) * vec2(size.x / size.y, 1.0);
    float radius = length(from_center);
    float bump = frame.w * perturb_bump((radius - frame.z) / parameters.ring_width);
    shift -= from_center * (bump / max(radius, 1e-6));
    shift += parameters.distortion_strength * (2.0 * image - 1.0);
    float pixel = parameters.reach == Perturb_reach_height ? size.y / 1080.0 : 1.0;
    return parameters.amount * pixel * shift;
}

vec2 perturb_turns(vec2 uv, vec4 frame, Perturb parameters) {
    return fract(parameters.strength.zw * uv.yx + frame.xy);
}
