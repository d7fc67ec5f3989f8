// SPDX-License-Identifier: MIT
#pragma once
// The row of OpenEXR, the format of frames, and what its compressions are called.

#include <array>
#include <string_view>

#include "formats/file_format.hpp"

namespace darkroom {

[[nodiscard]] const FileFormat& exr_format();

inline constexpr std::array<std::string_view, 10> exr_compressions{"none",  "rle", "zips", "zip",  "piz",
                                                                   "pxr24", "b44", "b44a", "dwaa", "dwab"};

}  // namespace darkroom
