// SPDX-License-Identifier: MIT
#pragma once
// JPEG files by libjpeg, row by row, as grey or RGB of 8 bits; what was made for ink comes as the light that it leaves,
// and a picture with a gain map as light in floats.

#include <memory>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Of bytes that check_jpeg() has passed; they outlive the source.
[[nodiscard]] Result<std::unique_ptr<PictureSource>> open_jpeg(std::span<const std::byte> bytes);

/// Linear light of a picture that was written here as sRGB: red, green, blue.
[[nodiscard]] Result<std::vector<float>> light_of_jpeg(std::span<const std::byte> bytes);

}  // namespace darkroom
