// SPDX-License-Identifier: MIT
#pragma once
// What is read of EXIF: how a picture is turned.

#include <cstddef>
#include <cstdint>
#include <span>

namespace darkroom {

/// 1 to 8, of a TIFF file's first directory (EXIF 2.32, 4.6.4); 1, upright, where there is none, or it is damaged.
[[nodiscard]] std::uint8_t orientation_of_exif(std::span<const std::byte> file);

}  // namespace darkroom
