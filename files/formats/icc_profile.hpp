// SPDX-License-Identifier: MIT
#pragma once
// What an ICC profile says of RGB (ICC.1:2022): its name (9.2.41; ICC.1:2001, 6.5.17), and where it is of three
// colorants and a curve (8.3.3), which light its numbers are.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/color_coding.hpp"

namespace darkroom {

/// In ASCII, other characters as '?'. Empty: it has none, or is not a profile.
[[nodiscard]] std::string profile_description(std::span<const std::byte> profile);

/// Primaries are relative to D50, as the profile's connection space is. None: it is of another kind, its channels have
/// curves of their own, or one that is neither a formula nor near sRGB's or a power.
[[nodiscard]] std::optional<ColorCoding> profile_coding(std::span<const std::byte> profile);

/// Has it curves, whatever they are? Then it is what they say, and not what its name says.
[[nodiscard]] bool has_curves(std::span<const std::byte> profile);

/// A profile of a display with these primaries, a white of D65 and the curve of sRGB (ICC.1:2022, version 4.3).
[[nodiscard]] std::vector<std::byte> display_profile(std::string_view name, const Chromaticities& primaries);

}  // namespace darkroom
