// SPDX-License-Identifier: MIT
#pragma once
// A picture as it is compared: files of integers keep their encoded values, files of floats their linear ones. Frames,
// which are always linear, are in frame_file.hpp.

#include <darkroom/result.hpp>
#include <filesystem>

#include "image/flip.hpp"
#include "image/picture.hpp"

namespace darkroom {

struct ComparablePicture {
    Picture picture;
    PictureEncoding encoding = PictureEncoding::Display;
};

/// Any known image file. The error text begins with the path.
[[nodiscard]] Result<ComparablePicture> read_comparable(const std::filesystem::path& path);

}  // namespace darkroom
