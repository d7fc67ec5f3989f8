// SPDX-License-Identifier: MIT
#pragma once
// Looks over the first picture of a TIFF file before a decoder may see it: its tiles or strips, where they lie and how
// many bytes they have, against the file and the sizes that are allowed.

#include <cstddef>
#include <darkroom/result.hpp>
#include <span>
#include <vector>

namespace darkroom {

/// The file as a decoder may see it: one picture, of whose tags those alone are left that say how its samples lie. An
/// error names no file. Refused: what is cut off; a tile of more than 8192 pixels a side; a tile, or a strip that is
/// packed, of more than 256 MiB; compressions that no renderer writes.
[[nodiscard]] Result<std::vector<std::byte>> check_tiff(std::span<const std::byte> file);

}  // namespace darkroom
