// SPDX-License-Identifier: MIT
#pragma once
// From the colour of a file to the working colour, scene-linear Rec. 709 with a D65 white: the sRGB transfer function
// for integer files, a 3x3 matrix for files that name their primaries. Display transforms are effects, not this.

#include <array>
#include <optional>

namespace darkroom {

struct Chromaticity {
    double x = 0;
    double y = 0;
    [[nodiscard]] bool operator==(const Chromaticity&) const = default;
};

/// The primaries and the white point of an RGB colour space, CIE 1931 x and y.
struct Chromaticities {
    Chromaticity red{0.64, 0.33};
    Chromaticity green{0.30, 0.60};
    Chromaticity blue{0.15, 0.06};
    Chromaticity white{0.3127, 0.3290};
};

/// Row-major, applied to a column of red, green, blue.
using ColorMatrix = std::array<double, 9>;

/// Linear RGB of these primaries to linear Rec. 709, with Bradford adaptation of the white point. Files whose primaries
/// are the axes of CIE XYZ hold tristimulus values: their nominal white (1/3, 1/3) is no viewing white, so nothing is
/// adapted. No value: the primaries span no colour space.
[[nodiscard]] std::optional<ColorMatrix> to_rec709(const Chromaticities& from);

}  // namespace darkroom
