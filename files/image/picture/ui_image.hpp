// SPDX-License-Identifier: MIT
#pragma once
// The interface from a picture's file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

/// Red, green, blue, alpha of 8 bits, sRGB-encoded and premultiplied after that: what Frame::ui holds. A file of
/// integers is read as frames are, with its colour and its alpha as it says them, and resampled to this size if it has
/// another. `warnings`: what read_frame tells. They and errors begin with the path.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_ui_image(const std::filesystem::path& path, std::uint32_t width,
                                                              std::uint32_t height,
                                                              std::vector<std::string>* warnings = nullptr);

}  // namespace darkroom
