// SPDX-License-Identifier: MIT
#pragma once
// The interface from a picture's file.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

/// Red, green, blue, alpha of 8 bits, sRGB-encoded and premultiplied after that: what Frame::ui holds. A file of
/// integers, whose alpha is straight as PNG has it, is resampled to this size if it has another. Errors begin with the
/// path.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_ui_image(const std::filesystem::path& path, std::uint32_t width,
                                                              std::uint32_t height);

}  // namespace darkroom
