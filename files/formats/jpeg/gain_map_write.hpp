// SPDX-License-Identifier: MIT
#pragma once
// Makes a second picture that brightens a JPEG picture, and one file of both (see gain_map.hpp): its numbers stand in
// it by ISO 21496-1 and as XMP of hdrgm, its place by CIPA DC-007 and by XMP of Google's container.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace darkroom {

struct MadeGainMap {
    std::vector<std::uint8_t> codes;  ///< red, green, blue
    double min = 0, max = 0;          ///< stops of the codes 0 and 255
    double headroom = 0;              ///< stops above white of the brightest light
};

/// Of two pictures of one size, in linear light, 1 being white: one as a display of standard range has it, three a
/// pixel, and one as a brighter display does, four a pixel.
[[nodiscard]] MadeGainMap make_gain_map(std::span<const float> base, std::span<const float> light);

/// `picture`: the map's codes as JPEG.
[[nodiscard]] std::vector<std::byte> join_gain_map(std::span<const std::byte> base, std::span<const std::byte> picture,
                                                   const MadeGainMap& map);

}  // namespace darkroom
