// SPDX-License-Identifier: MIT
// Linear light of Rec. 709 as code values of logarithmic curves, and back: ACEScct, ARRI LogC3 at EI 800 and Sony S-Log3 in
// their own primaries, and the library's LogShaper. Decoded values are clamped to half precision before they are Rec. 709.
#ifndef SHARED_LOG_CURVES
#define SHARED_LOG_CURVES

// As lut_reference.hpp works them out, which says where primaries and curves are published: ACES AP1 with the adaptation of
// Bradford, ARRI Wide Gamut 3, S-Gamut3.Cine.
const mat3 rec709_to_ap1 = mat3(0.613097402, 0.070193722, 0.020615593, 0.339523146, 0.916353879, 0.109569773, 0.047379451,
                                0.013452398, 0.869814634);
const mat3 ap1_to_rec709 = mat3(1.705050993, -0.130256418, -0.024003357, -0.621792121, 1.140804737, -0.128968976,
                                -0.083258872, -0.010548319, 1.152972333);
const mat3 rec709_to_awg3 = mat3(0.631321023, 0.036819934, 0.017369732, 0.270800727, 0.793036966, 0.148789185, 0.097878250,
                                 0.170143100, 0.833841083);
const mat3 awg3_to_rec709 = mat3(1.617523436, -0.070572741, -0.021101728, -0.537286622, 1.334613062, -0.226953875,
                                 -0.080236814, -0.264040321, 1.248055603);
const mat3 rec709_to_sgamut3_cine = mat3(0.645679478, 0.087529992, 0.036957420, 0.259114547, 0.759699563, 0.129280905,
                                         0.095205975, 0.152770446, 0.833761675);
const mat3 sgamut3_cine_to_rec709 = mat3(1.626947410, -0.178515527, -0.044436115, -0.540138539, 1.417940927, -0.195919966,
                                         -0.086808871, -0.239425400, 1.240356081);
const float log_curves_log2_10 = 3.321928095;
const float log_curves_log10_2 = 0.301029996;

vec3 log_curves_finite(vec3 light) { return clamp(light, -65504.0, 65504.0); }

vec3 acescct_encode(vec3 light) {
    light = rec709_to_ap1 * light;
    return mix((log2(max(light, vec3(1e-7))) + 9.72) / 17.52, 10.5402377416545 * light + 0.0729055341958355,
               lessThanEqual(light, vec3(0.0078125)));
}

vec3 acescct_decode(vec3 value) {
    vec3 light = mix((value - 0.0729055341958355) / 10.5402377416545, exp2(value * 17.52 - 9.72),
                     greaterThan(value, vec3(0.155251141552511)));
    return ap1_to_rec709 * log_curves_finite(light);
}

vec3 logc3_encode(vec3 light) {
    light = rec709_to_awg3 * light;
    return mix(5.367655 * light + 0.092809,
               0.247190 * log_curves_log10_2 * log2(max(5.555556 * light + 0.052272, vec3(1e-7))) + 0.385537,
               greaterThan(light, vec3(0.010591)));
}

vec3 logc3_decode(vec3 value) {
    vec3 light = mix((value - 0.092809) / 5.367655,
                     (exp2(log_curves_log2_10 * (value - 0.385537) / 0.247190) - 0.052272) / 5.555556,
                     greaterThan(value, vec3(5.367655 * 0.010591 + 0.092809)));
    return awg3_to_rec709 * log_curves_finite(light);
}

vec3 slog3_encode(vec3 light) {
    light = rec709_to_sgamut3_cine * light;
    return mix((light * ((171.2102946929 - 95.0) / 0.01125) + 95.0) / 1023.0,
               (420.0 + log_curves_log10_2 * 261.5 * log2(max((light + 0.01) / 0.19, vec3(1e-7)))) / 1023.0,
               greaterThanEqual(light, vec3(0.01125)));
}

vec3 slog3_decode(vec3 value) {
    vec3 light = mix((value * 1023.0 - 95.0) * (0.01125 / (171.2102946929 - 95.0)),
                     exp2(log_curves_log2_10 * (value * 1023.0 - 420.0) / 261.5) * 0.19 - 0.01,
                     greaterThanEqual(value, vec3(171.2102946929 / 1023.0)));
    return sgamut3_cine_to_rec709 * log_curves_finite(light);
}

// LogShaper: stops above and below a grey of 0.18, from -10 to 6.5.
vec3 log_shaper_encode(vec3 light) { return (log2(max(light, vec3(0.18 / 1024.0)) / 0.18) + 10.0) / 16.5; }

vec3 log_shaper_decode(vec3 value) {
    return mix(vec3(0.0), min(0.18 * exp2(value * 16.5 - 10.0), vec3(65504.0)), greaterThan(value, vec3(0.0)));
}
#endif
