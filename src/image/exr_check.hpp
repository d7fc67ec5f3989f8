// SPDX-License-Identifier: MIT
#pragma once
// Looks over the structure of an OpenEXR file before a decoder may see it: windows, channels, tiles and the table of
// chunks, against the size of the file. It decodes no pixel; it makes sure that what a decoder allocates is in
// proportion to the file, and that no part of the picture is missing.

#include <cstddef>
#include <darkroom/result.hpp>
#include <span>

namespace darkroom {

/// The largest width or height of a picture, in pixels, of any format.
inline constexpr long long max_picture_side = 65536;

/// An error names the defect without the file name, which the caller knows. Refused: what is no OpenEXR file, is cut
/// off or unfinished, is empty or larger than its bytes could hold, has deep pixels, or has subsampled channels.
[[nodiscard]] Result<> check_exr(std::span<const std::byte> file);

}  // namespace darkroom
