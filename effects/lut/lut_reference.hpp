// SPDX-License-Identifier: MIT
#pragma once
// Lut in double precision. The curves are those of their makers, the matrices follow from published primaries and white
// points.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/lut.hpp>
#include <darkroom/reference.hpp>
#include <optional>

#include "core/primaries.hpp"
#include "shared/finite_reference.hpp"
#include "shared/srgb_reference.hpp"
#include "tables/evaluate.hpp"
#include "tables/log_shaper.hpp"

namespace darkroom {

namespace lut_detail {

/// Academy, "ACEScct, A Quasi-Logarithmic Encoding of ACES Data for use within Color Grading Systems", S-2016-001:
/// the primaries AP1.
inline constexpr Chromaticities ap1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
/// Harald Brendel, "ALEXA Log C Curve, Usage in VFX", ARRI, 2017.
inline constexpr Chromaticities arri_wide_gamut_3{.red{0.6840, 0.3130}, .green{0.2210, 0.8480}, .blue{0.0861, -0.1020}};
/// Sony, "Technical Summary for S-Gamut3.Cine/S-Log3 and S-Gamut3/S-Log3", 2014.
inline constexpr Chromaticities s_gamut3_cine{.red{0.766, 0.275}, .green{0.225, 0.800}, .blue{0.089, -0.087}};

/// ARRI, "ARRI LogC4 Logarithmic Color Space, Specification", 2022.
inline constexpr Chromaticities arri_wide_gamut_4{.red{0.7347, 0.2653}, .green{0.1424, 0.8576}, .blue{0.0991, -0.0308}};
/// Panasonic, "V-Log/V-Gamut Reference Manual", 2014.
inline constexpr Chromaticities v_gamut{.red{0.730, 0.280}, .green{0.165, 0.840}, .blue{0.100, -0.030}};
/// Blackmagic Design, "DaVinci Wide Gamut Intermediate", 2020.
inline constexpr Chromaticities davinci_wide_gamut{
    .red{0.8000, 0.3130}, .green{0.1682, 0.9877}, .blue{0.0790, -0.1155}};

/// Of the tables of a space; none: those of the working space.
inline std::optional<Chromaticities> gamut_of(LutSpace space) {
    switch (space) {
        case LutSpace::Acescct:
            return ap1;
        case LutSpace::Logc3:
            return arri_wide_gamut_3;
        case LutSpace::Slog3:
            return s_gamut3_cine;
        case LutSpace::Logc4:
            return arri_wide_gamut_4;
        case LutSpace::Vlog:
            return v_gamut;
        case LutSpace::DavinciIntermediate:
            return davinci_wide_gamut;
        default:
            return std::nullopt;
    }
}

/// The constants of LogC4's specification.
struct LogC4 {
    double a = (262144.0 - 16) / 117.45, b = 928.0 / 1023, c = 95.0 / 1023;
    double s = 7 * std::log(2.0) * std::exp2(7 - 14 * c / b) / (a * b), t = (std::exp2(6 - 14 * c / b) - 64) / a;
};

/// The curve of one channel. ACEScct is equations 6 and 7 of S-2016-001, LogC3 has the constants for EI 800 and S-Log3
/// those of Sony's summary.
inline double encode(double x, LutSpace space) {
    switch (space) {
        case LutSpace::Display:
            return srgb_encoded(std::clamp(x, 0.0, 1.0));
        case LutSpace::SceneLinear:
            return LogShaper::encode(x);
        case LutSpace::Acescct:
            return x <= 0.0078125 ? 10.5402377416545 * x + 0.0729055341958355 : (std::log2(x) + 9.72) / 17.52;
        case LutSpace::Logc3:
            return x > 0.010591 ? 0.247190 * std::log10(5.555556 * x + 0.052272) + 0.385537 : 5.367655 * x + 0.092809;
        case LutSpace::Slog3:
            return x >= 0.01125 ? (420 + std::log10((x + 0.01) / (0.18 + 0.01)) * 261.5) / 1023
                                : (x * (171.2102946929 - 95) / 0.01125 + 95) / 1023;
        case LutSpace::Logc4: {
            const LogC4 k;
            return x >= k.t ? (std::log2(k.a * x + 64) - 6) / 14 * k.b + k.c : (x - k.t) / k.s;
        }
        case LutSpace::Vlog:
            return x >= 0.01 ? 0.241514 * std::log10(x + 0.00873) + 0.598206 : 5.6 * x + 0.125;
        case LutSpace::DavinciIntermediate:
            return x > 0.00262409 ? (std::log2(x + 0.0075) + 7) * 0.07329248 : 10.44426855 * x;
        case LutSpace::Linear:
            break;
    }
    return x;
}

inline double decode(double v, LutSpace space) {
    switch (space) {
        case LutSpace::Display:
            return srgb_decoded(std::clamp(v, 0.0, 1.0));
        case LutSpace::SceneLinear:
            return LogShaper::decode(v);
        case LutSpace::Acescct:
            return v <= 0.155251141552511 ? (v - 0.0729055341958355) / 10.5402377416545 : std::exp2(v * 17.52 - 9.72);
        case LutSpace::Logc3:
            return v > 5.367655 * 0.010591 + 0.092809 ? (std::pow(10, (v - 0.385537) / 0.247190) - 0.052272) / 5.555556
                                                      : (v - 0.092809) / 5.367655;
        case LutSpace::Slog3:
            return v >= 171.2102946929 / 1023 ? std::pow(10, (v * 1023 - 420) / 261.5) * (0.18 + 0.01) - 0.01
                                              : (v * 1023 - 95) * 0.01125 / (171.2102946929 - 95);
        case LutSpace::Logc4: {
            const LogC4 k;
            return v >= 0 ? (std::exp2(14 * (v - k.c) / k.b + 6) - 64) / k.a : v * k.s + k.t;
        }
        case LutSpace::Vlog:
            return v >= 0.181 ? std::pow(10, (v - 0.598206) / 0.241514) - 0.00873 : (v - 0.125) / 5.6;
        case LutSpace::DavinciIntermediate:
            return v > 0.02740668 ? std::exp2(v / 0.07329248 - 7) - 0.0075 : v / 10.44426855;
        case LutSpace::Linear:
            break;
    }
    return v;
}

}  // namespace lut_detail

/// A picture's colour as the tables of a space are given it, and back.
inline TableColor lut_encode_reference(const TableColor& light, LutSpace space) {
    using namespace lut_detail;
    TableColor out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = finite_reference(light[i]);
    if (const auto gamut = gamut_of(space)) out = multiply(conversion({}, *gamut).value(), out);
    for (double& value : out) value = encode(value, space);
    return out;
}
inline TableColor lut_decode_reference(TableColor value, LutSpace space) {
    using namespace lut_detail;
    for (double& one : value) one = finite_reference(decode(one, space));
    const auto gamut = gamut_of(space);
    return gamut ? multiply(conversion(*gamut, {}).value(), value) : value;
}

/// What stands in for a table that is not there.
inline const ColorTable& lut_identity() {
    static const ColorTable table{.size = 2,
                                  .cube = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1}};
    return table;
}

inline ReferenceImage lut_reference(const void* parameters, const ReferenceInput& input) {
    const Lut& values = *static_cast<const Lut*>(parameters);
    const auto* const named = find_resource<ColorTable>(input.resources, values.lut);
    const ColorTable& table = named == nullptr ? lut_identity() : *named;
    const auto* const other = find_resource<ColorTable>(input.resources, values.fade_to);
    ReferenceImage out = *input.picture;
    const auto how = values.interpolation == LutInterpolation::Tetrahedral ? TableInterpolation::Tetrahedral
                                                                           : TableInterpolation::Trilinear;
    const LutSpace back = values.result == LutResult::Display ? LutSpace::Display : values.space;
    const double strength{values.strength}, fade{other == nullptr ? 0.0f : values.fade};
    for (Rgba& color : out.pixels) {
        const TableColor given = lut_encode_reference({color.r, color.g, color.b}, values.space);
        TableColor found = evaluate(table, given, how);
        if (fade > 0) {
            const TableColor second = evaluate(*other, given, how);
            for (std::size_t i = 0; i < 3; ++i) found[i] += (second[i] - found[i]) * fade;
        }
        found = lut_decode_reference(found, back);
        const auto blend = [&](double from, double to) { return strength == 1 ? to : from + (to - from) * strength; };
        color = {blend(color.r, found[0]), blend(color.g, found[1]), blend(color.b, found[2]), color.a};
    }
    return out;
}

}  // namespace darkroom
