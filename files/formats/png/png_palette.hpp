// SPDX-License-Identifier: MIT
#pragma once
// The pixels of a PNG file with a palette, looked over for one that names no colour of it: decoders make black of that,
// or whatever lies there.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>

namespace darkroom {

struct PalettePicture {
    std::uint32_t width = 0, height = 0, bits = 8;
    bool is_interlaced = false;
    std::size_t colors = 0;  ///< of the palette
};

/// `packed` is the content of all IDAT chunks. Nothing is unpacked where every number of so many bits is a colour.
[[nodiscard]] Result<> check_palette(const PalettePicture& picture, std::span<const std::byte> packed);

}  // namespace darkroom
