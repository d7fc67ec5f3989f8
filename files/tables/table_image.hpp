// SPDX-License-Identifier: MIT
#pragma once
// Colour tables that come as pictures, for painters: n slices of n x n pixels in rows, blue rising from slice to slice,
// red to the right, green down: a strip (256x16 and its like), a column, a square of tiles (512x512); or a square
// HaldCLUT (Eskil Steenberg, 2006) of level L, L^3 pixels a side, whose pixels are the entries of a cube of L^2, row by
// row. A square that could be either is the one of which it is the smoother table.

#include <darkroom/resource.hpp>
#include <string>

#include "core/try.hpp"

namespace darkroom {

struct ImageTable {
    ColorTable table;
    std::string layout;  ///< "8x8 slices of 64x64", "HaldCLUT"
};

/// The edge of the cube that a picture of this size is. Errors name the size and what is allowed.
[[nodiscard]] Result<std::uint32_t> table_image_edge(std::uint32_t width, std::uint32_t height);
/// The pixels' numbers become entries as they are; alpha says nothing. Errors name the size or the pixel, and what is
/// allowed.
[[nodiscard]] Result<ImageTable> table_of_image(const ResourceImage& image);

}  // namespace darkroom
