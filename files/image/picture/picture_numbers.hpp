// SPDX-License-Identifier: MIT
#pragma once
// Pictures that are data, not to be seen: tables, masks, displacements.

#include <darkroom/resource.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <string>

#include "formats/file_part.hpp"

namespace darkroom {

/// A picture's numbers as the file has them: integers 0..1 without decoding, floats without a change of primaries. One
/// channel, or one with alpha, is grey; alpha that is not there is 1. What is not finite is 0. `check` sees the part
/// before its pixels are read, `left_out` becomes what Decoder::left_out() tells. Errors begin with the path.
[[nodiscard]] Result<ResourceImage> read_numbers(const std::filesystem::path& path,
                                                 Result<> (*check)(const FilePart&) = nullptr,
                                                 std::string* left_out = nullptr);

}  // namespace darkroom
