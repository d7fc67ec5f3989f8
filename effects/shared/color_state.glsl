// SPDX-License-Identifier: MIT
// From the numbers of a picture to those of an sRGB display, and back: `word` is 1, the transfer from bit 1 and the primaries
// from bit 4, numbered as in darkroom/color_state.hpp. The curve of sRGB goes on above 1 and below 0.
#ifndef SHARED_COLOR_STATE
#define SHARED_COLOR_STATE
#include "shared/sanitize.glsl"
#include "shared/srgb_unbounded.glsl"

// SMPTE ST 2084:2014, with light 1.0 for 10000 cd/m2.
// log2 of the curve's ratio is taken by the series of 2 atanh(z), with z the ratio's (r - 1) / (r + 1): |z| < 0.09, so three
// terms reach single precision. Vulkan asks less of log2, and the exponent 78.84 would multiply its error.
vec3 pq_encode(vec3 light) {
    vec3 y = pow(light, vec3(2610.0 / 16384.0));
    // c1 = 107/128, c2 = 2413/128, c3 = 2392/128
    vec3 z = (y - 1.0) * (21.0 / 128.0) / (235.0 / 128.0 + y * (4805.0 / 128.0));
    vec3 zz = z * z;
    vec3 log2_ratio = z * (2.0 / 0.69314718056) * (1.0 + zz * (1.0 / 3.0 + zz * (1.0 / 5.0)));
    return exp2((2523.0 / 32.0) * log2_ratio);
}
// Of y = code^(32/2523), which is near 1, the distance d = y - 1 counts: near the peak light changes by 7e2 times what y does.
// d is taken by the series of exp(x) - 1; |x| < 0.18 where there is light, and six terms reach single precision.
vec3 pq_decode(vec3 code) {
    vec3 x = log2(clamp(code, 7.3e-7, 1.0)) * (0.69314718056 * 32.0 / 2523.0);
    vec3 d = x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0))))));
    return pow(max(21.0 / 128.0 + d, 0.0) / (21.0 / 128.0 - (2392.0 / 128.0) * d), vec3(16384.0 / 2610.0));
}

// ITU-R BT.2087, and its inverse; P3 with a white of D65 from the chromaticities of SMPTE RP 431-2.
const mat3 color_state_rec2020 = mat3(0.627403896, 0.069097289, 0.016391439, 0.329283038, 0.919540395, 0.088013308,
                                      0.043313066, 0.011362316, 0.895595253);
const mat3 color_state_from_rec2020 = mat3(1.660491002, -0.124550475, -0.018150763, -0.587641140, 1.132899895, -0.100578897,
                                           -0.072849863, -0.008349420, 1.118729661);
const mat3 color_state_p3 = mat3(0.822461969, 0.033194199, 0.017082631, 0.177538031, 0.966805801, 0.072397440, 0.0, 0.0,
                                 0.910519929);
const mat3 color_state_from_p3 = mat3(1.224940176, -0.042056955, -0.019637555, -0.224940176, 1.042056955, -0.078636046, 0.0,
                                      0.0, 1.098273600);
const vec3 color_state_luminance = vec3(0.2627, 0.6780, 0.0593);

// The exponent of HLG's OOTF for a display of this peak: ITU-R BT.2100, table 5, note 5f. Beyond its range the extended
// formula of ITU-R BT.2390, which stays above 0.
float hlg_ootf(float peak_nits) {
    float octaves = log2(peak_nits / 1000.0);
    return peak_nits >= 400.0 && peak_nits <= 2000.0 ? 1.2 + 0.42 * 0.30102999566 * octaves : 1.2 * pow(1.111, octaves);
}
// ITU-R BT.2100: light relative to the display's peak, through the OOTF backwards and the OETF.
vec3 hlg_encode(vec3 light, float ootf) {
    light = clamp(light, 0.0, 1.0);
    vec3 scene = light * pow(max(dot(light, color_state_luminance), 1e-9), (1.0 - ootf) / ootf);
    vec3 power = 0.17883277 * log(max(12.0 * scene - 0.28466892, vec3(1e-6))) + 0.55991073;
    return mix(power, sqrt(3.0 * scene), lessThanEqual(scene, vec3(1.0 / 12.0)));
}
vec3 hlg_decode(vec3 code, float ootf) {
    code = clamp(code, 0.0, 1.0);
    vec3 power = (exp((code - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
    vec3 scene = mix(power, code * code / 3.0, lessThanEqual(code, vec3(0.5)));
    return scene * pow(max(dot(scene, color_state_luminance), 1e-9), ootf - 1.0);
}

// Linear numbers in Rec. 709, and back.
vec3 color_state_to_light(vec3 color, uint word, float ootf) {
    uint transfer = word >> 1 & 7u, primaries = word >> 4;
    if (transfer == 1u) color = srgb_decode_unbounded(color);
    if (transfer == 2u) color = pow(max(color, vec3(0.0)), vec3(2.2));
    if (transfer == 3u) color = pq_decode(color);
    if (transfer == 4u) color = hlg_decode(color, ootf);
    if (primaries == 1u) color = color_state_from_rec2020 * color;
    if (primaries == 2u) color = color_state_from_p3 * color;
    return color;
}
vec3 color_state_from_light(vec3 color, uint word, float limit, float ootf) {
    uint transfer = word >> 1 & 7u, primaries = word >> 4;
    if (primaries == 1u) color = color_state_rec2020 * color;
    if (primaries == 2u) color = color_state_p3 * color;
    if (transfer == 1u) return srgb_encode_unbounded(color);
    if (transfer == 2u) return pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2));
    if (transfer == 3u) return pq_encode(clamp(color, 0.0, limit));
    if (transfer == 4u) return hlg_encode(color, ootf);
    return transfer == 5u ? clamp(color, -limit, limit) : color;
}

vec3 color_state_to_srgb(vec3 color, uint word, float scale, float ootf) {
    return srgb_encode_unbounded(color_state_to_light(color, word, ootf) * scale);
}
vec3 color_state_from_srgb(vec3 color, uint word, float scale, float limit, float ootf) {
    return color_state_from_light(srgb_decode_unbounded(color) / scale, word, limit, ootf);
}

// The picture for the target: the states' words stand at bits 2 and 8. NaN becomes 0, and codes of sRGB end at 0 and 1.
vec3 color_state_convert(vec3 color, uint words, float scale, float limit, float ootf, float target_ootf) {
    vec3 light = color_state_to_light(sanitize(vec4(color, 1.0)).rgb, words >> 2 & 63u, ootf) * scale;
    uint target = words >> 8 & 63u;
    color = color_state_from_light(light, target, limit, target_ootf);
    return (target >> 1 & 7u) == 1u ? clamp(color, 0.0, 1.0) : color;
}
#endif
