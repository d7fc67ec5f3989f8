// SPDX-License-Identifier: MIT
#pragma once
// TIFF files as programs of pictures write them, by libtiff: grey or RGB, with alpha or without, of integers of 8 or 16
// bits or of halves or floats, in strips or tiles, its channels together or apart. OpenImageIO knows the others.

#include <memory>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Of bytes that check_tiff() has passed; they outlive the source. Nothing: the file is one of the others.
[[nodiscard]] Result<std::unique_ptr<PictureSource>> open_tiff(std::span<const std::byte> bytes);

}  // namespace darkroom
