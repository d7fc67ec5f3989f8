// SPDX-License-Identifier: MIT
#pragma once
// Looks over the chunks of a PNG file before a decoder may see it, and leaves out those that no picture needs. A text
// of a few bytes may inflate to gigabytes, which a decoder would do.

#include <cstddef>
#include <span>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

/// What a profile of colours may inflate to.
inline constexpr std::size_t max_png_profile_bytes = std::size_t{4} << 20;

/// The file as a decoder may see it; empty: as it is. Left are the picture, its palette and transparency, what says of
/// small numbers which colours they are, the first profile of colours, and of EXIF the orientation. An error names no
/// file. Refused: what is cut off or damaged, a palette of fewer colours than its pixels name, a profile of more than
/// 4 MiB, and chunks that a decoder must know and none does.
[[nodiscard]] Result<std::vector<std::byte>> check_png(std::span<const std::byte> file);

}  // namespace darkroom
