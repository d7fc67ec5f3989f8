// SPDX-License-Identifier: MIT
#pragma once
// The matrices between linear RGB colour spaces, from their primaries and white points.

#include <array>
#include <optional>

namespace darkroom {

struct Chromaticity {
    double x = 0;
    double y = 0;
    [[nodiscard]] bool operator==(const Chromaticity&) const = default;
};

/// The primaries and the white point of an RGB colour space, CIE 1931 x and y: of Rec. 709 (ITU-R BT.709-6, 2015).
struct Chromaticities {
    Chromaticity red{0.64, 0.33};
    Chromaticity green{0.30, 0.60};
    Chromaticity blue{0.15, 0.06};
    Chromaticity white{0.3127, 0.3290};
    [[nodiscard]] bool operator==(const Chromaticities&) const = default;
};

/// Within 1e-4: files keep them in 32 bits, and round them to four digits.
[[nodiscard]] bool is_near(const Chromaticities& a, const Chromaticities& b);

/// Row-major, applied to a column of red, green, blue.
using ColorMatrix = std::array<double, 9>;

[[nodiscard]] std::array<double, 3> multiply(const ColorMatrix& matrix, const std::array<double, 3>& color);

/// Linear RGB of one space to linear RGB of another, with Bradford adaptation where the white points differ. No value:
/// the primaries of one span no colour space.
[[nodiscard]] std::optional<ColorMatrix> conversion(const Chromaticities& from, const Chromaticities& to);

/// As a file is read: its linear RGB to linear Rec. 709. Primaries within 1e-4 of those of Rec. 709 are these, because
/// files keep them in 32 bits and a frame must come back as it was. Files whose primaries are the axes of CIE XYZ hold
/// tristimulus values: their nominal white (1/3, 1/3) is no viewing white, so nothing is adapted.
[[nodiscard]] std::optional<ColorMatrix> to_rec709(const Chromaticities& from);

}  // namespace darkroom
