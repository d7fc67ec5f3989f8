// SPDX-License-Identifier: MIT
#pragma once
// Follows the markers of a JPEG file to its end: libjpeg fills what is missing of a file that was cut off with gray and
// calls that success. Pictures out of proportion to the file are refused on the way (exr_check.hpp).

#include <cstddef>
#include <darkroom/result.hpp>
#include <span>

namespace darkroom {

/// An error names the defect without the file name.
[[nodiscard]] Result<> check_jpeg(std::span<const std::byte> file);

}  // namespace darkroom
