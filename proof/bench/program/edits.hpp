// SPDX-License-Identifier: MIT
#pragma once
// What a frame costs in which a look is edited: random edits of the documented look, one a frame, as an editor makes
// them, while the picture goes on.

#include <string_view>
#include <vector>

#include "bench/rows.hpp"

namespace darkroom::bench {

inline constexpr std::string_view edits_name = "edits";

/// Of a picture of 320 by 180, whatever the bed's size. None in a build without looks.
[[nodiscard]] Result<std::vector<Figure>> edit_figures(Device& device, std::uint32_t edits);

}  // namespace darkroom::bench
