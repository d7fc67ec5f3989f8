// SPDX-License-Identifier: MIT
#pragma once
// What alpha means, in and out. Files bring colours multiplied by it (OpenEXR, TIFF as its tag says) or straight (PNG,
// WebP, TIFF as its tag says): FilePart::is_associated. Code values become straight before they are decoded; light that
// keeps its alpha is multiplied by it from then on, so that filters and effects weigh it as it is seen. Files of floats
// are written so, files of integers straight.

#include <span>

#include "image/picture/picture.hpp"

namespace darkroom {

/// Multiplies straight colours by their alpha.
void associate(Picture& picture);

/// Code values that were multiplied by alpha, four a pixel, become straight; where alpha is 0, black.
void make_straight(std::span<float> rgba);

/// For straight files, out of straight code values: glow over what is transparent, which where alpha is 0 stands as it
/// adds to another picture, gets as much alpha as it is bright, so that it is still there over that one.
void make_alpha_of_glow(std::span<float> rgba);

}  // namespace darkroom
