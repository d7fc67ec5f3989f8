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

/// An error names the defect without the file name, which the caller knows. Refused: what is not an OpenEXR file, is
/// cut off or unfinished, is empty or larger than its bytes could hold, has deep pixels, or has chunks (a tile, or the
/// lines that are packed together) of more than 256 MiB.
[[nodiscard]] Result<> check_exr(std::span<const std::byte> file);

}  // namespace darkroom
