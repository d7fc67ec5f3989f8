// SPDX-License-Identifier: MIT
// scene_linear -> display_linear in [0, 1]. Negative light and NaN count as 0, infinity as tonemap_ceiling. The curves of
// BT.2390 and Gran Turismo 7 end at the peak, and keep negative light: it is colour outside of Rec. 709, which wider primaries show.

#include "shared/color_state.glsl"
#include "shared/sanitize.glsl"

// Beyond every operator's white, and its square is still far from the largest float.
const float tonemap_ceiling = 1e6;

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
vec3 tonemap_narkowicz(vec3 light) {
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
}

// Stephen Hill's fit of the ACES reference rendering transform and sRGB output transform, in ACES.hlsl of Matt
// Pettineo's "BakingLab", 2016. The matrices go from Rec. 709 to the transform's space and back.
vec3 tonemap_hill(vec3 light) {
    const mat3 to_aces = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 from_aces = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = to_aces * light;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return from_aces * v;
}

// Erik Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 4, on luminance.
vec3 tonemap_reinhard(vec3 light, float white) {
    float luminance = dot(light, vec3(0.2126, 0.7152, 0.0722));
    return light * ((1.0 + luminance / (white * white)) / (1.0 + luminance));
}

// John Hable, "Filmic Tonemapping Operators", 2010, without its constant terms: they cancel, and black stays black.
vec3 tonemap_hable_curve(vec3 x) {
    return x * (0.14 * x + 0.05 / 3.0) / (x * (0.15 * x + 0.5) + 0.06);
}

// Troy Sobotka, "AgX", 2022, in the polynomial form of Benjamin Wrensch, "Minimal AgX Implementation", 2023. Its result is
// made for a display of gamma 2.2, so that exponent brings it to display-linear light.
vec3 tonemap_agx_base(vec3 light) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float lowest_ev = -12.47393;
    const float highest_ev = 4.026069;
    vec3 ev = log2(max(inset * light, vec3(1e-10)));
    vec3 x = (clamp(ev, lowest_ev, highest_ev) - lowest_ev) / (highest_ev - lowest_ev);
    x = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x) - 0.00232;
    return pow(max(outset * x, vec3(0.0)), vec3(2.2));
}

// Khronos Group, "PBR Neutral Tone Mapper", 2024. The clamps stand for the branches of the specification: at their ends
// both sides agree.
vec3 tonemap_pbr_neutral(vec3 light) {
    const float compression_start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float lowest = min(min(min(light.r, light.g), light.b), 0.08);
    light -= lowest - 6.25 * lowest * lowest;
    float peak = max(max(max(light.r, light.g), light.b), compression_start);
    const float room = 1.0 - compression_start;
    float new_peak = 1.0 - room * room / (peak + room - compression_start);
    float saturation = 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(vec3(new_peak), light * (new_peak / peak), saturation);
}

// ITU-R BT.2390-10, 5.4.1, for a black of 0: a PQ value of up to `most` into one of up to `peak`. The spline leaves the knee
// with a slope of 1, so what is below stays.
float tonemap_eetf(float value, float most, float peak) {
    float part = peak / most, knee = 1.5 * part - 0.5, e = min(value / most, 1.0);
    if (part >= 1.0 || e <= knee) return min(value, min(most, peak));
    float t = (e - knee) / (1.0 - knee), tt = t * t, ttt = tt * t;
    return most * ((2.0 * ttt - 3.0 * tt + 1.0) * knee + (ttt - 2.0 * tt + t) * (1.0 - knee) + (3.0 * tt - 2.0 * ttt) * part);
}

// PQ of light whose 1.0 is 203 cd/m2, and back.
vec3 tonemap_pq(vec3 light) { return pq_encode(min(light * (203.0 / 10000.0), 1.0)); }
vec3 tonemap_from_pq(vec3 code) { return pq_decode(code) * (10000.0 / 203.0); }

vec3 tonemap_bt2390(vec3 light, float most, float peak) {
    float largest = max(max(light.r, light.g), max(light.b, 1e-9));
    float code = tonemap_pq(vec3(largest)).x, mapped = tonemap_eetf(code, most, peak);
    return mapped == code ? light : light * (tonemap_from_pq(vec3(mapped)).x / largest);
}

// ICtCp of ITU-R BT.2100, of light in Rec. 2020 by way of PQ.
const mat3 tonemap_to_lms = mat3(1688.0, 683.0, 99.0, 2146.0, 2951.0, 309.0, 262.0, 462.0, 3688.0) / 4096.0;
const mat3 tonemap_from_lms = mat3(3.436606694333079, -0.791329555598929, -0.025949899690593, -2.506452118656270,
                                   1.983600451792291, -0.098913714711726, 0.069845424323191, -0.192270896193362,
                                   1.124863614402319);
const mat3 tonemap_to_ictcp = mat3(2048.0, 6610.0, 17933.0, 2048.0, -13613.0, -17390.0, 0.0, 7003.0, -543.0) / 4096.0;
const mat3 tonemap_from_ictcp = mat3(1.0, 1.0, 1.0, 0.008609037037933, -0.008609037037933, 0.560031335710679,
                                     0.111029625003026, -0.111029625003026, -0.320627174987319);

// Chroma follows the intensity, so the hue stays.
vec3 tonemap_bt2390_ictcp(vec3 light, float most, float peak) {
    light = min(light, 10000.0 / 203.0);
    vec3 ictcp = tonemap_to_ictcp * tonemap_pq(max(tonemap_to_lms * (color_state_rec2020 * light), 0.0));
    float intensity = tonemap_eetf(ictcp.x, most, peak);
    if (intensity == ictcp.x) return light;
    float ratio = intensity / ictcp.x;
    vec3 lms = tonemap_from_ictcp * vec3(intensity, ictcp.yz * min(ratio, 1.0 / ratio));
    return color_state_from_rec2020 * (tonemap_from_lms * tonemap_from_pq(lms));
}

// H. Uchimura and K. Suzuki (Polyphony Digital), "Driving Toward Reality: Physically Based Tone Mapping and Perceptual
// Fidelity in Gran Turismo 7", SIGGRAPH 2025. Its paper white of 250 cd/m2 is 1.0 here, so that standard range is the
// high range of a display whose peak is white. A toe, a straight line from `middle` on, and above `straight` of the peak a
// shoulder.
vec3 tonemap_gt7_curve(vec3 x, float peak) {
    const float middle = 0.538 / 2.5, straight = 0.444, k = (straight - 1.0) / (0.25 - 1.0);
    vec3 low = mix(middle * pow(x / middle, vec3(1.28)), x, smoothstep(0.0, middle, x));
    vec3 shoulder = peak * (straight + k - k * exp((straight - x / peak) / k));
    return mix(low, shoulder, greaterThanEqual(x, vec3(straight * peak)));
}
vec3 tonemap_gt7_ictcp(vec3 wide) {
    return tonemap_to_ictcp * pq_encode(max(tonemap_to_lms * wide, 0.0) * (250.0 / 10000.0));
}

// A mean of the curve on each channel, which skews hues as film does, and of its intensity with the hue of the light, whose
// chroma fades towards the peak.
vec3 tonemap_gt7(vec3 light, float peak) {
    vec3 wide = color_state_rec2020 * clamp(light, -tonemap_ceiling, tonemap_ceiling);
    vec3 skewed = tonemap_gt7_curve(max(wide, 0.0), peak), ictcp = tonemap_gt7_ictcp(wide);
    float fade = 1.0 - smoothstep(0.98, 1.16, ictcp.x / tonemap_gt7_ictcp(vec3(peak)).x);
    vec3 lms = pq_decode(tonemap_from_ictcp * vec3(tonemap_gt7_ictcp(skewed).x, ictcp.yz * fade)) * (10000.0 / 250.0);
    vec3 kept = max(tonemap_from_lms * lms, 0.0);
    return color_state_from_rec2020 * min(mix(skewed, kept, 0.6), peak);
}

vec3 tonemap_to_peak(vec3 color, Tonemap parameters) {
    vec3 light = sanitize(vec4(color, 1.0)).rgb;
    float peak = parameters.peak_nits / 203.0;
    vec3 codes = tonemap_pq(vec3(parameters.white, peak, 0.0));
    // Ends at the peak in Rec. 2020.
    if (parameters.curve == Tonemap_curve_gt7) return tonemap_gt7(light, peak);
    light = parameters.curve == Tonemap_curve_bt2390 ? tonemap_bt2390(light, codes.x, codes.y)
                                                     : tonemap_bt2390_ictcp(light, codes.x, codes.y);
    return clamp(light, -peak, peak);
}

vec4 tonemap(vec4 color, Pixel pixel, Tonemap parameters) {
    vec3 light = clamp(color.rgb, 0.0, tonemap_ceiling);
    uint curve = parameters.curve;
    if (curve == Tonemap_curve_aces_narkowicz) {
        light = tonemap_narkowicz(light);
    } else if (curve == Tonemap_curve_aces_hill) {
        light = tonemap_hill(light);
    } else if (curve == Tonemap_curve_reinhard_extended) {
        light = tonemap_reinhard(light, parameters.white);
    } else if (curve == Tonemap_curve_hable) {
        // Exposure bias 2; white at 11.2.
        light = tonemap_hable_curve(2.0 * light) / tonemap_hable_curve(vec3(11.2));
    } else if (curve == Tonemap_curve_agx) {
        light = tonemap_agx_base(light);
    } else if (curve == Tonemap_curve_khronos_pbr_neutral) {
        light = tonemap_pbr_neutral(light);
    }
    light = clamp(light, 0.0, 1.0);
    if (curve >= Tonemap_curve_bt2390) light = tonemap_to_peak(color.rgb, parameters);
    return vec4(light, color.a);
}
