// SPDX-License-Identifier: MIT
#pragma once
// The numbers of a picture, as a file has them, to light, and the light to linear Rec. 709. Alpha stays.

#include "core/primaries.hpp"
#include "formats/color_coding.hpp"
#include "formats/file_part.hpp"
#include "image/picture/picture.hpp"

namespace darkroom {

/// `samples`: of the file; its integers are in 0..1 here. HLG becomes what a display of 1000 cd/m2 shows.
void decode(Picture& color, SampleKind samples, const TransferCurve& curve);

/// Pixels that are not finite stay as they are.
void convert(Picture& color, const ColorMatrix& matrix);

}  // namespace darkroom
