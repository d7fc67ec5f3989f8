// SPDX-License-Identifier: MIT
#pragma once
// Lut in double precision. The curves are those of their makers, the matrices are worked out from published primaries
// and white points (SMPTE RP 177-1993), with the adaptation of Bradford where the white points differ.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/lut.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"
#include "shared/srgb_reference.hpp"
#include "tables/evaluate.hpp"
#include "tables/log_shaper.hpp"

namespace darkroom {

namespace lut_detail {

using Matrix3 = std::array<TableColor, 3>;  ///< rows

inline TableColor multiply(const Matrix3& m, const TableColor& v) {
    TableColor out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}
inline Matrix3 multiply(const Matrix3& a, const Matrix3& b) {
    Matrix3 out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}
inline Matrix3 inverse(const Matrix3& m) {
    Matrix3 out{};
    double determinant = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        for (std::size_t row = 0; row < 3; ++row) {
            const std::size_t next = (row + 1) % 3, last = (row + 2) % 3;
            out[i][row] = m[next][j] * m[last][k] - m[next][k] * m[last][j];
        }
        determinant += m[0][i] * out[i][0];
    }
    for (TableColor& row : out)
        for (double& value : row) value /= determinant;
    return out;
}

struct Gamut {
    std::array<std::array<double, 2>, 3> primaries;
    std::array<double, 2> white;
};
inline constexpr std::array<double, 2> d65{0.3127, 0.3290};
/// ITU-R BT.709-6, 2015.
inline constexpr Gamut rec709{{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, d65};
/// Academy, "ACEScct, A Quasi-Logarithmic Encoding of ACES Data for use within Color Grading Systems", S-2016-001:
/// the primaries AP1.
inline constexpr Gamut ap1{{{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}}, {0.32168, 0.33767}};
/// Harald Brendel, "ALEXA Log C Curve, Usage in VFX", ARRI, 2017.
inline constexpr Gamut arri_wide_gamut_3{{{{0.6840, 0.3130}, {0.2210, 0.8480}, {0.0861, -0.1020}}}, d65};
/// Sony, "Technical Summary for S-Gamut3.Cine/S-Log3 and S-Gamut3/S-Log3", 2014.
inline constexpr Gamut s_gamut3_cine{{{{0.766, 0.275}, {0.225, 0.800}, {0.089, -0.087}}}, d65};

inline TableColor xyz_of(const std::array<double, 2>& xy) { return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]}; }

inline Matrix3 to_xyz(const Gamut& gamut) {
    Matrix3 columns{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t row = 0; row < 3; ++row) columns[row][i] = xyz_of(gamut.primaries[i])[row];
    const TableColor scale = multiply(inverse(columns), xyz_of(gamut.white));
    for (TableColor& row : columns)
        for (std::size_t i = 0; i < 3; ++i) row[i] *= scale[i];
    return columns;
}

/// Karl Lam, "Metamerism and Colour Constancy", thesis at Bradford, 1985, without its non-linear part.
inline Matrix3 adaptation(const std::array<double, 2>& from, const std::array<double, 2>& to) {
    const Matrix3 cone{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    const TableColor a = multiply(cone, xyz_of(from)), b = multiply(cone, xyz_of(to));
    return multiply(inverse(cone), multiply({{{b[0] / a[0], 0, 0}, {0, b[1] / a[1], 0}, {0, 0, b[2] / a[2]}}}, cone));
}

inline Matrix3 conversion(const Gamut& from, const Gamut& to) {
    return multiply(inverse(to_xyz(to)), multiply(adaptation(from.white, to.white), to_xyz(from)));
}

inline const Gamut& gamut_of(LutSpace space) {
    switch (space) {
        case LutSpace::Acescct:
            return ap1;
        case LutSpace::Logc3:
            return arri_wide_gamut_3;
        case LutSpace::Slog3:
            return s_gamut3_cine;
        default:
            return rec709;
    }
}

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
    }
    return v;
}

/// What is no number is no light, and the rest is within half precision.

}  // namespace lut_detail

/// A picture's colour as the tables of a space are given it, and back.
inline TableColor lut_encode_reference(const TableColor& light, LutSpace space) {
    using namespace lut_detail;
    TableColor out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = finite_reference(light[i]);
    if (&gamut_of(space) != &rec709) out = multiply(conversion(rec709, gamut_of(space)), out);
    for (double& value : out) value = encode(value, space);
    return out;
}
inline TableColor lut_decode_reference(TableColor value, LutSpace space) {
    using namespace lut_detail;
    for (double& one : value) one = finite_reference(decode(one, space));
    return &gamut_of(space) == &rec709 ? value : multiply(conversion(gamut_of(space), rec709), value);
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
