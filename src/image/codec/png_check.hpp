// SPDX-License-Identifier: MIT
#pragma once
// Looks over the chunks of a PNG file before libpng may see it, as exr_check.hpp does for OpenEXR: checksums, the end,
// and whether the size that the header claims can be in the file. libpng would print what it finds on the terminal.

#include <cstddef>
#include <darkroom/result.hpp>
#include <span>

namespace darkroom {

/// An error names the defect without the file name.
[[nodiscard]] Result<> check_png(std::span<const std::byte> file);

}  // namespace darkroom
