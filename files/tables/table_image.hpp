// SPDX-License-Identifier: MIT
#pragma once
// Colour tables that come as pictures, for painters: a strip of n slices of n x n pixels, side by side or below each
// other, blue rising from slice to slice, red to the right, green down (256x16 and its like); or a square HaldCLUT
// (Eskil Steenberg, 2006) of level L, L^3 pixels a side, whose pixels are the entries of a cube of L^2, row by row.

#include <darkroom/resource.hpp>

#include "core/try.hpp"

namespace darkroom {

/// The edge of the cube that a picture of this size is. Errors name the size and what is allowed.
[[nodiscard]] Result<std::uint32_t> table_image_edge(std::uint32_t width, std::uint32_t height);
/// The pixels' numbers become entries as they are; alpha says nothing. Errors name the size or the pixel, and what is
/// allowed.
[[nodiscard]] Result<ColorTable> table_of_image(const ResourceImage& image);

}  // namespace darkroom
