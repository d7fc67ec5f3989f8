// SPDX-License-Identifier: MIT
#pragma once
// Where things lie in a JPEG file: segments by their marks, and the pictures behind the first. Files may be damaged:
// what lies outside of one is not there.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "formats/file_color.hpp"

namespace darkroom {

/// What stands behind the first such mark of an APPn segment before the picture.
[[nodiscard]] std::span<const std::byte> jpeg_segment(std::span<const std::byte> file, std::size_t application,
                                                      std::string_view mark);
/// The first packet of XMP.
[[nodiscard]] std::string_view xmp_of_jpeg(std::span<const std::byte> file);

/// CIPA DC-007 (2009), 5.2.3: further pictures, but for smaller copies of the first.
[[nodiscard]] std::vector<std::span<const std::byte>> further_jpegs(std::span<const std::byte> file);

/// By its profile and by EXIF, of the code values of its first picture.
[[nodiscard]] FileColor color_of_jpeg(std::span<const std::byte> file);

}  // namespace darkroom
