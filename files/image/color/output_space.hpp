// SPDX-License-Identifier: MIT
#pragma once
// Colour spaces that pictures may be written in, by name, and how files say so: PNG by the chunk cICP, OpenEXR by its
// chromaticities.

#include <darkroom/color_state.hpp>
#include <darkroom/result.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace darkroom {

struct OutputSpace {
    std::string_view name;
    std::optional<ColorState> integers, floats;  ///< what such files hold; none: they cannot
};

/// srgb, p3, rec2020, pq or hlg. An error names them.
[[nodiscard]] Result<OutputSpace> find_output_space(std::string_view name);
/// The names of all, with `separator` between them.
[[nodiscard]] std::string output_space_names(std::string_view separator);
/// The names of those that integers, or floats, can be written in.
[[nodiscard]] std::string output_space_names_of(bool is_integer);

}  // namespace darkroom
