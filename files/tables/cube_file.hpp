// SPDX-License-Identifier: MIT
#pragma once
// Files of colour tables in the text format .cube: Adobe, "Cube LUT Specification", version 1.0, 2013, and the form
// with a shaper before the cube that DaVinci Resolve writes (LUT_1D_INPUT_RANGE, LUT_3D_INPUT_RANGE), whose numbers may
// be codes of video (LUT_IN_VIDEO_RANGE, LUT_OUT_VIDEO_RANGE).

#include <cstdint>
#include <darkroom/resource.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

inline constexpr std::uint32_t min_table_size = 2, max_shaper_size = 65536, max_cube_size = 256;
/// Bytes of a file at most: those of the largest cube with 40 a line, and some more.
inline constexpr std::uintmax_t max_cube_file = std::uintmax_t{1} << 30;

/// A table, and what its file says about it.
struct TableFile {
    ColorTable table;
    std::string title;
    std::vector<std::string> comments;  ///< without their '#'; of a file that was read, those before its first entry
};

/// Reads the text of a file, strictly: every line is known, every number finite, and the counts are those that the
/// sizes ask for. Memory is proportional to the text, whatever its sizes say. Errors are `shown:line: thing, value,
/// what is allowed`.
[[nodiscard]] Result<TableFile> parse_cube(std::string_view text, std::string_view shown);

[[nodiscard]] Result<TableFile> read_cube(const std::filesystem::path& path);

/// The text of a file that parse_cube() reads back with the same bits. A table with a shaper and a cube is in Resolve's
/// form, whose ranges are the same for all channels: one of another kind is refused.
[[nodiscard]] Result<std::string> write_cube(const TableFile& file);

}  // namespace darkroom
