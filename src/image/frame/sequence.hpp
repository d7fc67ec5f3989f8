// SPDX-License-Identifier: MIT
#pragma once
// Names of numbered files: shot.%04d.exr, shot.####.exr or shot.@@@@.exr stands for shot.0001.exr, shot.0002.exr and so
// on. Only names and folders are looked at, no file is opened.

#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

/// Each input that has a number pattern (%d, %4d, %04d, or two or more # or @, one for each digit; in the file name)
/// becomes the files that exist and match, in the order of their numbers; a range [first-last] after the extension
/// keeps those within. Other inputs stay as they are, whether they exist or not. An error if a pattern matches nothing.
[[nodiscard]] Result<std::vector<std::filesystem::path>> expand_inputs(std::span<const std::string> inputs);

[[nodiscard]] bool has_number_pattern(const std::filesystem::path& path);

/// The path with its pattern replaced by a number; the path itself if it has none.
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& pattern, long long number);

/// The frame number in a file name: its last group of digits before the extension.
[[nodiscard]] std::optional<long long> frame_number(const std::filesystem::path& path);

}  // namespace darkroom
