// SPDX-License-Identifier: MIT
#pragma once
// The tone mapping operators in double precision, as they were published. Negative light and NaN count as 0, and light
// beyond every operator's white, infinity too, as 1e6.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/tonemap.hpp>
#include <darkroom/reference.hpp>

#include "shared/color_state_reference.hpp"
#include "shared/finite_reference.hpp"

namespace darkroom {

namespace tonemap_detail {

using Color = std::array<double, 3>;
using Rows = std::array<Color, 3>;

inline Color multiply(const Rows& rows, const Color& v) {
    Color out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
    return out;
}

template <class Function>
Color each(Color color, Function function) {
    for (double& value : color) value = function(value);
    return color;
}

/// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
inline double narkowicz(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

/// Stephen Hill's fit of the ACES reference rendering transform and sRGB output transform, in ACES.hlsl of Matt
/// Pettineo's "BakingLab", 2016.
inline Color hill(const Color& light) {
    const Rows to_aces{{{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}}};
    const Rows from_aces{{{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}}};
    const auto fit = [](double v) {
        return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    };
    return multiply(from_aces, each(multiply(to_aces, light), fit));
}

/// Erik Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 4, on luminance.
inline Color reinhard_extended(const Color& light, double white) {
    const double luminance = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    const double scale = (1.0 + luminance / (white * white)) / (1.0 + luminance);
    return each(light, [scale](double v) { return v * scale; });
}

/// John Hable, "Filmic Tonemapping Operators", 2010.
inline double hable(double light) {
    const double shoulder = 0.15, linear = 0.50, angle = 0.10, toe = 0.20, numerator = 0.02, denominator = 0.30;
    const double white = 11.2, exposure_bias = 2.0;
    const auto curve = [=](double x) {
        return (x * (shoulder * x + angle * linear) + toe * numerator) /
                   (x * (shoulder * x + linear) + toe * denominator) -
               numerator / denominator;
    };
    return curve(exposure_bias * light) / curve(white);
}

/// Troy Sobotka, "AgX", 2022, in the polynomial form of Benjamin Wrensch, "Minimal AgX Implementation", 2023; the last
/// step decodes for a display of gamma 2.2.
inline Color agx(const Color& light) {
    const Rows inset{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                      {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                      {0.0423756549057051, 0.0784336, 0.879142973793104}}};
    const Rows outset{{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                       {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                       {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
    const auto contrast = [](double v) {
        const double lowest_ev = -12.47393, highest_ev = 4.026069;
        const double ev = std::clamp(std::log2(std::max(v, 1e-10)), lowest_ev, highest_ev);
        const double x = (ev - lowest_ev) / (highest_ev - lowest_ev);
        return 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
               0.4298 * x * x + 0.1191 * x - 0.00232;
    };
    const Color encoded = multiply(outset, each(multiply(inset, light), contrast));
    return each(encoded, [](double v) { return std::pow(std::max(v, 0.0), 2.2); });
}

/// Khronos Group, "PBR Neutral Tone Mapper", specification, 2024.
inline Color khronos_pbr_neutral(const Color& light) {
    const double f90 = 0.04, compression_start = 0.8 - f90, desaturation = 0.15;
    const double lowest = *std::min_element(light.begin(), light.end());
    const double offset = lowest <= 2.0 * f90 ? lowest - lowest * lowest / (4.0 * f90) : f90;
    const Color color = each(light, [offset](double v) { return v - offset; });
    const double peak = *std::max_element(color.begin(), color.end());
    if (peak <= compression_start) return color;
    const double room = 1.0 - compression_start;
    const double new_peak = 1.0 - room * room / (peak + 1.0 - 2.0 * compression_start);
    const double saturation = 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return each(color, [=](double v) { return v * new_peak / peak * saturation + new_peak * (1.0 - saturation); });
}

/// ITU-R BT.2390-10, 5.4.1, for a black of 0, in PQ: up to `most` into up to `peak`.
inline double eetf(double value, double most, double peak) {
    const double e1 = std::min(value / most, 1.0), max_lum = std::min(peak / most, 1.0), ks = 1.5 * max_lum - 0.5;
    if (e1 <= ks) return std::min(value, most);
    if (ks >= 1) return most;
    const double t = (e1 - ks) / (1 - ks);
    return most * ((2 * t * t * t - 3 * t * t + 1) * ks + (t * t * t - 2 * t * t + t) * (1 - ks) +
                   (3 * t * t - 2 * t * t * t) * max_lum);
}
/// PQ of light whose 1.0 is 203 cd/m2, and back.
inline double pq_of(double light) { return pq_encoded(std::clamp(light * 203 / 10000, 0.0, 1.0)); }
inline double light_of(double code) { return pq_decoded(code) * 10000 / 203; }

inline Color bt2390(const Color& light, double most, double peak) {
    const double largest = std::max({light[0], light[1], light[2], 1e-9});
    const double gain = light_of(eetf(pq_of(largest), pq_of(most), pq_of(peak))) / largest;
    return each(light, [=](double v) { return v * gain; });
}

constexpr double n = 4096;
inline const Rows to_lms{{{1688 / n, 2146 / n, 262 / n}, {683 / n, 2951 / n, 462 / n}, {99 / n, 309 / n, 3688 / n}}};
inline const Rows to_ictcp{{{0.5, 0.5, 0}, {6610 / n, -13613 / n, 7003 / n}, {17933 / n, -17390 / n, -543 / n}}};

/// The same on the intensity of ICtCp (ITU-R BT.2100), to which the chroma is scaled.
inline Color bt2390_ictcp(const Color& light, double most, double peak) {
    using color_state_detail::solved;
    const Color capped = each(light, [](double v) { return std::min(v, 10000.0 / 203); });
    const Color lms = multiply(to_lms, multiply(color_state_detail::rec2020, capped));
    Color ictcp = multiply(to_ictcp, each(lms, pq_of));
    const double intensity = eetf(ictcp[0], pq_of(most), pq_of(peak)), ratio = intensity / ictcp[0];
    if (intensity == ictcp[0]) return capped;
    const double chroma = std::min(ratio, 1 / ratio);
    ictcp = {intensity, ictcp[1] * chroma, ictcp[2] * chroma};
    return solved(color_state_detail::rec2020, solved(to_lms, each(solved(to_ictcp, ictcp), light_of)));
}

/// H. Uchimura and K. Suzuki (Polyphony Digital), "Driving Toward Reality: Physically Based Tone Mapping and Perceptual
/// Fidelity in Gran Turismo 7", SIGGRAPH 2025, in its unit, which is 100 cd/m2; white is 250 cd/m2.
inline double gt7_curve(double x, double peak) {
    const double alpha = 0.25, middle = 0.538, straight = 0.444, toe_strength = 1.28;
    const double k = (straight - 1) / (alpha - 1);
    if (x < 0) return 0;
    if (x >= straight * peak)
        return peak * (straight + k) - peak * k * std::exp(straight / k) * std::exp(-x / (k * peak));
    const double t = std::min(x / middle, 1.0), weight = t * t * (3 - 2 * t);
    return (1 - weight) * middle * std::pow(x / middle, toe_strength) + weight * x;
}

inline Color gt7(const Color& light, double peak_of_white) {
    using color_state_detail::solved;
    const double peak = 2.5 * peak_of_white;
    const auto ictcp_of = [](const Color& rgb) {
        return multiply(to_ictcp,
                        each(multiply(to_lms, rgb), [](double v) { return pq_encoded(std::max(v, 0.0) / 100); }));
    };
    const Color rgb = each(multiply(color_state_detail::rec2020, light), [](double v) { return 2.5 * v; });
    const Color skewed = each(rgb, [=](double v) { return gt7_curve(v, peak); });
    const Color ictcp = ictcp_of(rgb);
    const double t = std::clamp((ictcp[0] / ictcp_of({peak, peak, peak})[0] - 0.98) / (1.16 - 0.98), 0.0, 1.0);
    const double fade = 1 - t * t * (3 - 2 * t);
    const Color lms = each(solved(to_ictcp, {ictcp_of(skewed)[0], ictcp[1] * fade, ictcp[2] * fade}),
                           [](double v) { return 100 * pq_decoded(std::clamp(v, 0.0, 1.0)); });
    const Color kept = solved(to_lms, lms);
    Color out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = std::min(0.4 * skewed[i] + 0.6 * std::max(kept[i], 0.0), peak) / 2.5;
    return solved(color_state_detail::rec2020, out);
}

/// Negative light stays: it is colour outside of Rec. 709.
inline Color to_peak(const Color& color, const Tonemap& parameters) {
    const double most = parameters.white, peak = double{parameters.peak_nits} / 203;
    const Color light = each(color, finite_reference);
    // Ends at the peak in Rec. 2020.
    if (parameters.curve == TonemapOperator::Gt7)
        return gt7(each(light, [](double v) { return std::clamp(v, -1e6, 1e6); }), peak);
    const Color out =
        parameters.curve == TonemapOperator::Bt2390 ? bt2390(light, most, peak) : bt2390_ictcp(light, most, peak);
    return each(out, [=](double v) { return std::clamp(v, -peak, peak); });
}

}  // namespace tonemap_detail

inline Rgba tonemap_reference(Rgba color, const ReferencePixel&, const Tonemap& parameters) {
    using namespace tonemap_detail;
    const auto finite = [](double v) { return v > 0.0 ? std::min(v, 1e6) : 0.0; };
    Color light = each({color.r, color.g, color.b}, finite);
    switch (parameters.curve) {
        case TonemapOperator::AcesNarkowicz:
            light = each(light, narkowicz);
            break;
        case TonemapOperator::AcesHill:
            light = hill(light);
            break;
        case TonemapOperator::ReinhardExtended:
            light = reinhard_extended(light, double{parameters.white});
            break;
        case TonemapOperator::Hable:
            light = each(light, hable);
            break;
        case TonemapOperator::Agx:
            light = agx(light);
            break;
        case TonemapOperator::KhronosPbrNeutral:
            light = khronos_pbr_neutral(light);
            break;
        case TonemapOperator::Linear:
            break;
        case TonemapOperator::Bt2390:
        case TonemapOperator::Bt2390Ictcp:
        case TonemapOperator::Gt7:
            light = to_peak({color.r, color.g, color.b}, parameters);
            return {light[0], light[1], light[2], color.a};
    }
    light = each(light, [](double v) { return std::clamp(v, 0.0, 1.0); });
    return {light[0], light[1], light[2], color.a};
}

}  // namespace darkroom
