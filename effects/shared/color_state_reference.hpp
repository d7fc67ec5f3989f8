// SPDX-License-Identifier: MIT
#pragma once
// What the numbers of a picture mean, in double precision: code values to light and back, by the standards.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/color_state.hpp>
#include <darkroom/reference.hpp>

#include "shared/srgb_reference.hpp"

namespace darkroom {

/// SMPTE ST 2084:2014, inverse EOTF, for [0, 1] of 10000 cd/m2.
inline double pq_encoded(double light) {
    const double m1 = 2610.0 / 16384.0, m2 = 2523.0 / 4096.0 * 128.0;
    const double c1 = 3424.0 / 4096.0, c2 = 2413.0 / 4096.0 * 32.0, c3 = 2392.0 / 4096.0 * 32.0;
    const double y = std::pow(light, m1);
    return std::pow((c1 + c2 * y) / (1.0 + c3 * y), m2);
}
/// Its EOTF.
inline double pq_decoded(double code) {
    const double m1 = 2610.0 / 16384.0, m2 = 2523.0 / 4096.0 * 128.0;
    const double c1 = 3424.0 / 4096.0, c2 = 2413.0 / 4096.0 * 32.0, c3 = 2392.0 / 4096.0 * 32.0;
    const double y = std::pow(std::clamp(code, 0.0, 1.0), 1 / m2);
    return std::pow(std::max(y - c1, 0.0) / (c2 - c3 * y), 1 / m1);
}

namespace color_state_detail {

using Color = std::array<double, 3>;
/// ITU-R BT.2087; P3 with a white of D65.
inline constexpr std::array<Color, 3> rec2020{{{0.627403896, 0.329283038, 0.043313066},
                                               {0.069097289, 0.919540395, 0.011362316},
                                               {0.016391439, 0.088013308, 0.895595253}}};
inline constexpr std::array<Color, 3> p3{
    {{0.822461969, 0.177538031, 0}, {0.033194199, 0.966805801, 0}, {0.017082631, 0.072397440, 0.910519929}}};

inline Color multiplied(const std::array<Color, 3>& rows, const Color& v) {
    Color out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
    return out;
}
/// By Cramer's rule.
inline Color solved(const std::array<Color, 3>& m, const Color& v) {
    const auto determinant = [](const Color& a, const Color& b, const Color& c) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
               c[0] * (a[1] * b[2] - a[2] * b[1]);
    };
    const auto column = [&](std::size_t i) { return Color{m[0][i], m[1][i], m[2][i]}; };
    const double whole = determinant(column(0), column(1), column(2));
    return {determinant(v, column(1), column(2)) / whole, determinant(column(0), v, column(2)) / whole,
            determinant(column(0), column(1), v) / whole};
}
inline double luminance(const Color& c) { return 0.2627 * c[0] + 0.6780 * c[1] + 0.0593 * c[2]; }

}  // namespace color_state_detail

/// The exponent of HLG's OOTF for a display of this peak: ITU-R BT.2100, table 5, and beyond its range ITU-R BT.2390.
inline double hlg_ootf_reference(double peak_nits) {
    const bool is_in_range = peak_nits >= 400 && peak_nits <= 2000;
    return is_in_range ? 1.2 + 0.42 * std::log10(peak_nits / 1000) : 1.2 * std::pow(1.111, std::log2(peak_nits / 1000));
}

/// Light in cd/m2 and Rec. 709 of the numbers of a picture in this state.
inline std::array<double, 3> nits_of(std::array<double, 3> v, const ColorState& state) {
    using namespace color_state_detail;
    const auto each = [&](auto function) {
        for (double& x : v) x = function(x);
    };
    if (state.transfer == Transfer::Srgb) each(srgb_decoded);
    if (state.transfer == Transfer::Gamma22) each([](double x) { return std::pow(std::max(x, 0.0), 2.2); });
    if (state.transfer == Transfer::Pq) each(pq_decoded);
    if (state.transfer == Transfer::Hlg) {
        each([](double x) {
            x = std::clamp(x, 0.0, 1.0);
            return x <= 0.5 ? x * x / 3 : (std::exp((x - 0.55991073) / 0.17883277) + 0.28466892) / 12;
        });
        const double gain = std::pow(std::max(luminance(v), 1e-9), hlg_ootf_reference(double{state.peak_nits}) - 1);
        each([=](double x) { return x * gain; });
    }
    if (state.primaries == Primaries::Rec2020) v = solved(rec2020, v);
    if (state.primaries == Primaries::P3) v = solved(p3, v);
    each([&](double x) { return x * double{state.unit_nits()}; });
    return v;
}
/// And back; code values end at the state's peak.
inline std::array<double, 3> numbers_of(std::array<double, 3> v, const ColorState& state) {
    using namespace color_state_detail;
    const double unit = double{state.unit_nits()}, limit = double{state.peak_nits} / unit;
    const auto each = [&](auto function) {
        for (double& x : v) x = function(x);
    };
    each([=](double x) { return x / unit; });
    if (state.primaries == Primaries::Rec2020) v = multiplied(rec2020, v);
    if (state.primaries == Primaries::P3) v = multiplied(p3, v);
    if (state.transfer == Transfer::Srgb) each(srgb_encoded);
    if (state.transfer == Transfer::Gamma22) each([](double x) { return std::pow(std::clamp(x, 0.0, 1.0), 1 / 2.2); });
    if (state.transfer == Transfer::Pq) each([=](double x) { return pq_encoded(std::clamp(x, 0.0, limit)); });
    if (state.transfer == Transfer::Scrgb) each([=](double x) { return std::clamp(x, -limit, limit); });
    if (state.transfer == Transfer::Hlg) {
        each([](double x) { return std::clamp(x, 0.0, 1.0); });
        const double ootf = hlg_ootf_reference(double{state.peak_nits});
        const double gain = std::pow(std::max(luminance(v), 1e-9), (1 - ootf) / ootf);
        each([=](double x) {
            x *= gain;
            return x <= 1.0 / 12 ? std::sqrt(3 * x) : 0.17883277 * std::log(12 * x - 0.28466892) + 0.55991073;
        });
    }
    return v;
}

}  // namespace darkroom
