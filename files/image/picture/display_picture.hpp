// SPDX-License-Identifier: MIT
#pragma once
// A picture as it is compared: files of integers keep their encoded values, files of floats their linear ones, and NaN
// and infinity stay. Frames, which are always linear and finite, are in frame_file.hpp.

#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "formats/color_coding.hpp"
#include "image/compare/flip.hpp"
#include "image/frame/layer_file.hpp"
#include "image/picture/picture.hpp"

namespace darkroom {

struct ComparablePicture {
    Picture picture;  ///< as large as the display window
    PictureEncoding encoding = PictureEncoding::Display;
    std::optional<ColorCoding> coding;  ///< of code values, where the file says it
    std::string color_said;             ///< by what; empty: it does not
};

/// Any known image file. Floats of other primaries than Rec. 709 are converted, but for pixels that are not finite. The
/// error text begins with the path.
[[nodiscard]] Result<ComparablePicture> read_comparable(const std::filesystem::path& path);
/// The color of an opened file.
[[nodiscard]] Result<ComparablePicture> read_comparable(LayerFile& file);

}  // namespace darkroom
