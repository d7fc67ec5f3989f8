// SPDX-License-Identifier: MIT
#pragma once
// Names of numbered files: shot.%04d.exr, shot.####.exr, shot.@@@@.exr or shot.$F4.exr stands for shot.0001.exr,
// shot.0002.exr and so on. Only names and folders are looked at, no file is opened.

#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

struct NumberedFile {
    std::filesystem::path path;
    long long number = 0;
    [[nodiscard]] bool operator==(const NumberedFile&) const = default;
    [[nodiscard]] auto operator<=>(const NumberedFile&) const = default;
};

/// Each input that has a number pattern in its file name (%d, %4d, %04d, $F, $F4, or two or more # or @, one for each
/// digit) becomes the files that exist and match, in the order of their numbers; frames in brackets after the extension
/// (see FrameSet) keep those. An error if a pattern matches nothing, or two files of one number. Other inputs stay as
/// they are, whether they exist or not: their numbers are the one group of digits in which their names differ, else
/// frame_number(). Where files have no number, or two have the same one, all are numbered from 1 on.
[[nodiscard]] Result<std::vector<NumberedFile>> expand_inputs(std::span<const std::string> inputs);

[[nodiscard]] bool has_number_pattern(const std::filesystem::path& path);

/// The path with its pattern replaced by a number; the path itself if it has none.
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& pattern, long long number);

/// All names that the pattern knows the number by, numbered() first: below 0 the sign stands among the digits or before
/// them.
[[nodiscard]] std::vector<std::filesystem::path> spellings(const std::filesystem::path& pattern, long long number);

/// The frame number in a file name: the last group of digits before the extension, without versions such as v2.
[[nodiscard]] std::optional<long long> frame_number(const std::filesystem::path& path);

}  // namespace darkroom
