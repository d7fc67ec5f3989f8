// SPDX-License-Identifier: MIT
// Linear light of Rec. 709 as code values of logarithmic curves, and back: ACEScct, ARRI LogC3 at EI 800 and LogC4, Sony
// S-Log3, Panasonic V-Log and DaVinci Intermediate in their own primaries, and the library's LogShaper. Decoded values are
// clamped to half precision before they are Rec. 709.
#ifndef LUT_LOG_CURVES
#define LUT_LOG_CURVES

// As lut_reference.hpp works them out, which says where primaries and curves are published: ACES AP1 with the adaptation of
// Bradford, ARRI Wide Gamut 3, S-Gamut3.Cine, ARRI Wide Gamut 4, V-Gamut, DaVinci Wide Gamut.
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
const mat3 rec709_to_awg4 = mat3(0.565836540, 0.088625637, 0.017750040, 0.340330999, 0.809346842, 0.109447621, 0.093832461,
                                 0.102027521, 0.872802339);
const mat3 awg4_to_rec709 = mat3(1.893123443, -0.205700358, -0.012705743, -0.780881504, 1.340257489, -0.152184876,
                                 -0.112241939, -0.134557131, 1.164890619);
const mat3 rec709_to_vgamut = mat3(0.585196147, 0.078588567, 0.022794238, 0.322641622, 0.819627115, 0.114217024, 0.092162231,
                                   0.101784318, 0.862988738);
const mat3 vgamut_to_rec709 = mat3(1.806575884, -0.170090343, -0.025205784, -0.695697274, 1.305955216, -0.154468329,
                                   -0.110878610, -0.135864873, 1.179674113);
const mat3 rec709_to_davinci = mat3(0.562767456, 0.077754635, 0.064669200, 0.323516589, 0.749577346, 0.191998692,
                                    0.113715955, 0.172668019, 0.743332108);
const mat3 davinci_to_rec709 = mat3(1.898614899, -0.168948786, -0.121539161, -0.792176183, 1.488975754, -0.315675853,
                                    -0.106438716, -0.320026968, 1.437215014);
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

// The constants a, b, c, s and t of ARRI's specification.
vec3 logc4_encode(vec3 light) {
    light = rec709_to_awg4 * light;
    return mix((light + 0.01805699612) / 0.1135972086,
               (log2(max(2231.826309 * light + 64.0, vec3(1e-7))) - 6.0) * (0.9071358749 / 14.0) + 0.0928641251,
               greaterThanEqual(light, vec3(-0.01805699612)));
}

vec3 logc4_decode(vec3 value) {
    vec3 light = mix(value * 0.1135972086 - 0.01805699612,
                     (exp2((value - 0.0928641251) * (14.0 / 0.9071358749) + 6.0) - 64.0) / 2231.826309,
                     greaterThanEqual(value, vec3(0.0)));
    return awg4_to_rec709 * log_curves_finite(light);
}

vec3 vlog_encode(vec3 light) {
    light = rec709_to_vgamut * light;
    return mix(5.6 * light + 0.125, 0.241514 * log_curves_log10_2 * log2(max(light + 0.00873, vec3(1e-7))) + 0.598206,
               greaterThanEqual(light, vec3(0.01)));
}

vec3 vlog_decode(vec3 value) {
    vec3 light = mix((value - 0.125) / 5.6, exp2(log_curves_log2_10 * (value - 0.598206) / 0.241514) - 0.00873,
                     greaterThanEqual(value, vec3(0.181)));
    return vgamut_to_rec709 * log_curves_finite(light);
}

vec3 davinci_encode(vec3 light) {
    light = rec709_to_davinci * light;
    return mix(10.44426855 * light, (log2(max(light + 0.0075, vec3(1e-7))) + 7.0) * 0.07329248,
               greaterThan(light, vec3(0.00262409)));
}

vec3 davinci_decode(vec3 value) {
    vec3 light = mix(value / 10.44426855, exp2(value / 0.07329248 - 7.0) - 0.0075, greaterThan(value, vec3(0.02740668)));
    return davinci_to_rec709 * log_curves_finite(light);
}

// LogShaper: stops above and below a grey of 0.18, from -10 to 6.5.
// Its first light is 0 by a choice: behind a logarithm that is a bit off, black would be that light.
vec3 log_shaper_encode(vec3 light) {
    const vec3 first = vec3(0.18 / 1024.0);
    return mix((log2(max(light, first) / 0.18) + 10.0) / 16.5, vec3(0.0), lessThanEqual(light, first));
}

vec3 log_shaper_decode(vec3 value) {
    return mix(vec3(0.0), min(0.18 * exp2(value * 16.5 - 10.0), vec3(65504.0)), greaterThan(value, vec3(0.0)));
}
#endif
