// SPDX-License-Identifier: MIT
#pragma once
// What OpenColorIO says of a table that it cannot read, in one line of ours: its sentences name the path again, in
// brackets or without, its own classes, and the line at one end or the other.

#include <filesystem>
#include <string>
#include <string_view>

namespace darkroom {

/// "line 3: cannot be read as .clf: inBitDepth is missing".
[[nodiscard]] std::string words_of_reader(std::string_view said, const std::filesystem::path& table);

}  // namespace darkroom
