// SPDX-License-Identifier: MIT
#pragma once
// What a picture's file says of its colour.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "formats/color_coding.hpp"

namespace darkroom {

struct FileColor {
    std::optional<ColorCoding> coding;  ///< none: the file says nothing that is understood
    std::string warning;                ///< what is not obeyed; empty: nothing
    std::string said;                   ///< by what it says so: "cICP 9 16 0 1"; empty: it does not
};

/// Of a matrix and a curve, or sRGB and Display P3 by their names, since some of them are tables. No profile: nothing.
[[nodiscard]] FileColor color_of_profile(std::span<const std::byte> profile, bool is_integer = true);

/// Of code values, what EXIF says behind all that the format itself says: Adobe RGB (1998), where that says nothing.
[[nodiscard]] FileColor with_exif(FileColor found, std::span<const std::byte> exif);

}  // namespace darkroom
