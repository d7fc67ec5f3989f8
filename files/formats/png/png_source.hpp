// SPDX-License-Identifier: MIT
#pragma once
// PNG files by libpng, row by row; what is interlaced is decoded as a whole when it is first read. Grey of few bits
// comes as 8 bits, a palette as its colours, a colour that is transparent as alpha.

#include <memory>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Of bytes that check_png() has passed; they outlive the source.
[[nodiscard]] Result<std::unique_ptr<PictureSource>> open_png(std::span<const std::byte> bytes);

}  // namespace darkroom
