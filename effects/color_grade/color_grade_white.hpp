// SPDX-License-Identifier: MIT
#pragma once
// The colour science of the white balance, in double precision: which light is white, and what makes it so.

#include <array>
#include <cmath>
#include <cstddef>

namespace darkroom::color_grade {

using Triple = std::array<double, 3>;
using Matrix3 = std::array<Triple, 3>;  ///< rows

constexpr double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Triple product(const Matrix3& m, const Triple& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
constexpr Matrix3 transposed(const Matrix3& m) {
    return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}
constexpr Matrix3 product(const Matrix3& a, const Matrix3& b) {
    const Matrix3 columns = transposed(b);
    return transposed({product(a, columns[0]), product(a, columns[1]), product(a, columns[2])});
}
constexpr Triple cross(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
constexpr Matrix3 inverse(const Matrix3& m) {
    const double determinant = dot(m[0], cross(m[1], m[2]));
    Matrix3 columns{cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    for (Triple& column : columns)
        for (double& value : column) value /= determinant;
    return transposed(columns);
}

/// ITU-R BT.709: the luminance of linear light.
inline constexpr Triple luminance_weights{0.2126, 0.7152, 0.0722};

/// IEC 61966-2-1: linear Rec. 709 to CIE XYZ, white D65.
inline constexpr Matrix3 rec709_to_xyz{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
/// CIE XYZ to the cone responses of CAT02 (CIE 159:2004, "A Colour Appearance Model for Colour Management Systems:
/// CIECAM02").
inline constexpr Matrix3 xyz_to_cones{{{0.7328, 0.4296, -0.1624}, {-0.7036, 1.6975, 0.0061}, {0.0030, 0.0136, 0.9834}}};

struct Chromaticity {
    double x = 0, y = 0;
};

/// CIE daylight of a temperature in kelvin (D. B. Judd, D. L. MacAdam and G. Wyszecki, "Spectral Distribution of
/// Typical Daylight as a Function of Correlated Color Temperature", 1964; CIE 15). The locus is stated from 4000 K on;
/// below it is continued, and at 2500 K lies 0.014 from the black body in x.
inline Chromaticity daylight(double kelvin) {
    const double t = 1000 / kelvin;
    const double x = kelvin <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                    : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    return {x, (-3 * x + 2.870) * x - 0.275};
}

/// Daylight, moved by tint / 3000 across the locus in CIE 1960 uv, toward green for a tint above 0.
inline Chromaticity tinted_daylight(double kelvin, double tint) {
    struct Uv {
        double u = 0, v = 0;
    };
    const auto uv_at = [](double at) {
        const auto [x, y] = daylight(at);
        const double scale = 1 / (-2 * x + 12 * y + 3);
        return Uv{4 * x * scale, 6 * y * scale};
    };
    // Across is along, turned by a right angle: a thousandth to both sides tells the direction.
    const Uv here = uv_at(kelvin), warmer = uv_at(kelvin * 0.999), colder = uv_at(kelvin * 1.001);
    const double du = warmer.u - colder.u, dv = warmer.v - colder.v, length = std::hypot(du, dv);
    const double u = here.u - dv / length * tint / 3000, v = here.v + du / length * tint / 3000;
    const double scale = 1 / (2 * u - 8 * v + 4);
    return {3 * u * scale, 2 * v * scale};
}

/// Cone responses to a light of luminance 1.
inline Triple cones_of(const Chromaticity& c) {
    return product(xyz_to_cones, Triple{c.x / c.y, 1, (1 - c.x - c.y) / c.y});
}

/// Linear Rec. 709 to the same, so that the light of `kelvin` and `tint` becomes white: the cones are scaled one by one
/// (J. von Kries, 1902).
inline Matrix3 white_balance(double kelvin, double tint) {
    const Matrix3 to_cones = product(xyz_to_cones, rec709_to_xyz);
    const Triple from = cones_of(tinted_daylight(kelvin, tint)), to = cones_of(daylight(6504));
    Matrix3 scaled = to_cones;
    for (std::size_t cone = 0; cone < 3; ++cone)
        for (double& value : scaled[cone]) value *= to[cone] / from[cone];
    return product(inverse(to_cones), scaled);
}

/// Turns hues about the axis of greys by an angle in degrees, then adds the grey that keeps the luminance (Paul
/// Haeberli, "Matrix Operations for Image Processing", 1993).
inline Matrix3 hue_rotation(double angle_degrees) {
    const double angle = angle_degrees * 0.017453292519943295, third = (1 - std::cos(angle)) / 3;
    const double same = std::cos(angle) + third, side = std::sin(angle) / std::sqrt(3.0);
    Matrix3 turn{
        {{same, third - side, third + side}, {third + side, same, third - side}, {third - side, third + side, same}}};
    const Triple after = product(transposed(turn), luminance_weights);
    for (Triple& row : turn)
        for (std::size_t i = 0; i < 3; ++i) row[i] += luminance_weights[i] - after[i];
    return turn;
}

}  // namespace darkroom::color_grade
