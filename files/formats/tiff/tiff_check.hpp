// SPDX-License-Identifier: MIT
#pragma once
// Looks over a picture of a TIFF file before a decoder may see it, the first that is no smaller copy of another: its
// tiles or strips, where they lie and how many bytes they have, against the file and the sizes that are allowed.

#include <cstddef>
#include <darkroom/result.hpp>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

/// The file as a decoder may see it: one picture, of whose tags those alone are left that say how its samples lie. An
/// error names no file. Refused: what is cut off; a tile of more than 8192 pixels a side, of more than 256 MiB, or of
/// more than 16 MiB and the picture; strips that are the same bytes again and again; compressions that no renderer
/// writes.
[[nodiscard]] Result<std::vector<std::byte>> check_tiff(std::span<const std::byte> file);

/// The ICC profile of that picture (ICC.1:2022, B.4), as it lies in the file. Empty: there is none.
[[nodiscard]] std::span<const std::byte> profile_of_tiff(std::span<const std::byte> file);

/// See FileFormat::left_out: of pages, but for smaller copies.
[[nodiscard]] std::string left_out_of_tiff(std::span<const std::byte> file);

}  // namespace darkroom
