// SPDX-License-Identifier: MIT
#pragma once
// Colour spaces by the names of the Color Interop Forum (ASWF, "Color Space Encodings for Texture Assets and CG
// Rendering" and "Display Encodings"), which Blender 5, OpenImageIO 3.2 and OpenColorIO 2.5 write into the attribute
// colorInteropID of OpenEXR: "lin_ap1_scene" is ACEScg.

#include <darkroom/color_state.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "formats/color_coding.hpp"

namespace darkroom {

struct InteropSpace {
    ColorCoding coding;
    bool is_data = false;     ///< "data": numbers that are no colour
    bool is_unknown = false;  ///< "unknown": nobody knows
};

/// CURVE_PRIMARIES_scene or CURVE_PRIMARIES_display, data or unknown; a namespace before a colon does not count. None:
/// no name of the forum.
[[nodiscard]] std::optional<InteropSpace> find_interop_space(std::string_view id);

/// What floats of these primaries are called; empty: they have no name.
[[nodiscard]] std::string interop_id_of(const Chromaticities& primaries);

}  // namespace darkroom
