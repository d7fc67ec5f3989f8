// SPDX-License-Identifier: MIT
#include "core/primaries.hpp"

#include <cmath>

namespace darkroom {
namespace {

using Vector = std::array<double, 3>;

ColorMatrix product(const ColorMatrix& a, const ColorMatrix& b) {
    ColorMatrix out{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t i = 0; i < 3; ++i) out[row * 3 + column] += a[row * 3 + i] * b[i * 3 + column];
    return out;
}

std::optional<ColorMatrix> inverse(const ColorMatrix& m) {
    const ColorMatrix cofactors{m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                                m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                                m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
    const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
    if (!(std::abs(determinant) > 1e-9)) return std::nullopt;
    ColorMatrix result = cofactors;
    for (double& value : result) value /= determinant;
    return result;
}

// SMPTE RP 177-1993, Derivation of Basic Television Color Equations, section 3.3: the columns are the primaries, scaled
// so that equal red, green and blue give the white point with Y = 1.
std::optional<ColorMatrix> to_xyz(const Chromaticities& c) {
    if (!(std::abs(c.white.y) > 1e-9)) return std::nullopt;
    const ColorMatrix primaries{c.red.x,
                                c.green.x,
                                c.blue.x,
                                c.red.y,
                                c.green.y,
                                c.blue.y,
                                1 - c.red.x - c.red.y,
                                1 - c.green.x - c.green.y,
                                1 - c.blue.x - c.blue.y};
    const auto inverted = inverse(primaries);
    if (!inverted) return std::nullopt;
    const Vector scale = multiply(*inverted, {c.white.x / c.white.y, 1.0, (1 - c.white.x - c.white.y) / c.white.y});
    ColorMatrix result = primaries;
    for (std::size_t i = 0; i < 9; ++i) result[i] *= scale[i % 3];
    return result;
}

// Lam, K. M., Metamerism and Colour Constancy (1985): the Bradford cone responses, scaled from one white to the other.
std::optional<ColorMatrix> adaptation(const Chromaticity& from, const Chromaticity& to) {
    constexpr ColorMatrix bradford{0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
    const Vector source = multiply(bradford, {from.x / from.y, 1.0, (1 - from.x - from.y) / from.y});
    const Vector target = multiply(bradford, {to.x / to.y, 1.0, (1 - to.x - to.y) / to.y});
    ColorMatrix scaled = bradford;
    for (std::size_t row = 0; row < 3; ++row) {
        if (!(std::abs(source[row]) > 1e-9)) return std::nullopt;
        for (std::size_t column = 0; column < 3; ++column) scaled[row * 3 + column] *= target[row] / source[row];
    }
    return product(*inverse(bradford), scaled);
}

bool is_near(const Chromaticity& a, const Chromaticity& b) {
    return std::abs(a.x - b.x) < 1e-4 && std::abs(a.y - b.y) < 1e-4;
}

}  // namespace

bool is_near(const Chromaticities& a, const Chromaticities& b) {
    return is_near(a.red, b.red) && is_near(a.green, b.green) && is_near(a.blue, b.blue) && is_near(a.white, b.white);
}

std::array<double, 3> multiply(const ColorMatrix& m, const std::array<double, 3>& v) {
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

std::optional<ColorMatrix> conversion(const Chromaticities& from, const Chromaticities& to) {
    const auto rgb_to_xyz = to_xyz(from), target_to_xyz = to_xyz(to);
    if (!rgb_to_xyz || !target_to_xyz) return std::nullopt;
    const auto xyz_to_rgb = inverse(*target_to_xyz);
    if (!xyz_to_rgb) return std::nullopt;
    if (is_near(from.white, to.white)) return product(*xyz_to_rgb, *rgb_to_xyz);
    const auto adapted = adaptation(from.white, to.white);
    if (!adapted) return std::nullopt;
    return product(*xyz_to_rgb, product(*adapted, *rgb_to_xyz));
}

std::optional<ColorMatrix> to_rec709(const Chromaticities& from) {
    const Chromaticities rec709;
    if (is_near(from, rec709)) return ColorMatrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (!is_near(from.red, {1, 0}) || !is_near(from.green, {0, 1}) || !is_near(from.blue, {0, 0}))
        return conversion(from, rec709);
    const auto tristimulus = to_xyz(from);
    if (!tristimulus) return std::nullopt;
    return product(*inverse(*to_xyz(rec709)), *tristimulus);
}

}  // namespace darkroom
