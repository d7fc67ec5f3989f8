// SPDX-License-Identifier: MIT
#pragma once
// FLIP: how visible the difference of two pictures is to a viewer who alternates between them, per pixel, 0 to 1.
// Written from Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020 (display-encoded pictures)
// and Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", 2021 (scene-linear pictures).
// It is not a distance for optimisation, and it ignores alpha.

#include <cstdint>
#include <darkroom/result.hpp>
#include <vector>

#include "image/picture/picture.hpp"

namespace darkroom {

/// What the numbers of a picture mean.
enum class PictureEncoding {
    Display,      ///< sRGB-encoded, 0 to 1; what lies outside is clamped, as a display would
    SceneLinear,  ///< linear Rec. 709 without an upper bound; negative values count as 0
};

struct FlipDesc {
    PictureEncoding encoding = PictureEncoding::Display;
    /// Pixels per degree of visual angle; the default is a display 0.7 m and 3840 pixels wide, seen from 0.7 m.
    double pixels_per_degree = 67.02064327658226;
};

struct FlipErrors {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> errors;  ///< one per pixel, top row first
    double mean = 0.0;
    double weighted_median = 0.0;  ///< errors above and below it have the same sum
    double min = 0.0;
    double max = 0.0;
    double start_exposure = 0.0;  ///< in stops; scene-linear pictures only
    double stop_exposure = 0.0;   ///< in stops
    std::uint32_t exposures = 0;  ///< how many exposures were compared; 0 for display-encoded pictures
};

/// Compares two pictures. A pixel in which only one of them has a NaN gets the error 1; elsewhere NaN counts as 0.
/// Errors: the sizes differ, a picture is empty, pixels_per_degree outside [1, 1000].
[[nodiscard]] Result<FlipErrors> flip(const Picture& reference, const Picture& test, const FlipDesc& desc = {});

}  // namespace darkroom
