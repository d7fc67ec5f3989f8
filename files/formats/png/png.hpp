// SPDX-License-Identifier: MIT
#pragma once
// The row of PNG, and what its chunks say of its colours.

#include <string>

#include "formats/file_format.hpp"

namespace darkroom {

[[nodiscard]] const FileFormat& png_format();
/// The chunks cICP, iCCP, sRGB, gAMA and cHRM, in that order of precedence (PNG, third edition, 11.3.2), then EXIF.
[[nodiscard]] FileColor png_color(std::span<const std::byte> file);
/// See FileFormat::left_out: of an animation.
[[nodiscard]] std::string png_left_out(std::span<const std::byte> file);

}  // namespace darkroom
