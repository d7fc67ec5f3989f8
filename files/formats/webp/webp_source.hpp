// SPDX-License-Identifier: MIT
#pragma once
// WebP files, lossy and lossless, by libwebp: a picture of 8 bits that is decoded as a whole when it is first read.

#include <memory>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Of bytes that check_webp() has passed; they outlive the source.
[[nodiscard]] Result<std::unique_ptr<PictureSource>> open_webp(std::span<const std::byte> bytes);

}  // namespace darkroom
