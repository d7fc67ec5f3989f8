// SPDX-License-Identifier: MIT
#pragma once
// How sharp a picture is, from the picture of one straight edge that is slanted against the pixels: its modulation
// transfer function, after ISO 12233.

#include <darkroom/result.hpp>

#include "image/picture/picture.hpp"

namespace darkroom {

struct EdgeSharpness {
    double mtf50 = 0;          ///< cycles a pixel, where half of the contrast is left; at most 1
    double angle_degrees = 0;  ///< of the edge against the axis of the pixels that is nearest to it
    double contrast = 0;       ///< of its sides
};

/// `luminance`: of light (not of codes), an edge between two even sides that crosses the picture from top to bottom or
/// from left to right. Errors: smaller than 16x16, no contrast, an edge along the pixels or at 45 degrees.
[[nodiscard]] Result<EdgeSharpness> edge_sharpness(const Plane<1>& luminance);

}  // namespace darkroom
