// SPDX-License-Identifier: MIT
#pragma once
// Looks over the structure of an OpenEXR file before a decoder may see it: windows, channels, tiles and the table of
// chunks, against the size of the file. It decodes no pixel; it makes sure that what a decoder allocates is in
// proportion to the file, and that no part of the picture is missing.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/try.hpp"

namespace darkroom {

/// The largest width or height of a picture, in pixels, of any format.
inline constexpr long long max_picture_side = 65536;

/// What the pixels of a file may take once they are decoded, of any format: 1 GiB always, beyond that 128 bytes for
/// each byte of the file. Flat pictures are packed up to 1000 times by deflate and 30000 times by DWAB, so one of 8K in
/// floats (531 MB, packed to 17 kB) is within the first, and what a camera or a renderer makes is never near the
/// second.
[[nodiscard]] Result<> check_decoded_size(std::uint64_t bytes, std::size_t file_size);

/// An error names the defect without the file name, which the caller knows. Refused: what is not an OpenEXR file, is
/// cut off or unfinished, is empty or larger than its bytes could hold, has deep pixels, or has chunks (a tile, or the
/// lines that are packed together) of more than 256 MiB.
[[nodiscard]] Result<> check_exr(std::span<const std::byte> file);

}  // namespace darkroom
