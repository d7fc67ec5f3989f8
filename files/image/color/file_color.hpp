// SPDX-License-Identifier: MIT
#pragma once
// What a picture's file says of its colour: the chunks cICP, iCCP, sRGB, gAMA and cHRM of PNG, in that order of
// precedence (PNG, third edition, 11.3.2), and the ICC profile of JPEG, TIFF and WebP.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "decoders/file_kind.hpp"
#include "image/color/color_coding.hpp"

namespace darkroom {

struct FileColor {
    std::optional<ColorCoding> coding;  ///< none: the file says nothing that is understood
    std::string warning;                ///< what is not obeyed; empty: nothing
    std::string said;                   ///< by what it says so: "cICP 9 16 0 1"; empty: it does not
};

/// Of a file whose structure has been checked, with integers or floats in it.
[[nodiscard]] FileColor file_color(FileKind kind, std::span<const std::byte> file, bool is_integer);

}  // namespace darkroom
