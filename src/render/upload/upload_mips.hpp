// SPDX-License-Identifier: MIT
#pragma once
// Mip levels of 8-bit pictures, each a box-filtered half of the one before, in linear light where the picture is
// sRGB-encoded. On the CPU, so that every device shows the same textures.

#include <cstdint>
#include <span>
#include <vector>

namespace darkroom::render {

struct MipLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Levels 1, 2, ... down to 1x1 of level 0 in `rgba`, four bytes a pixel; alpha is linear always. Odd sizes are
/// filtered by three taps (Guthe and Heckbert, "Non-Power-of-Two Mipmapping", 2005).
[[nodiscard]] std::vector<MipLevel> mip_levels(std::uint32_t width, std::uint32_t height,
                                               std::span<const std::uint8_t> rgba, bool is_srgb);

}  // namespace darkroom::render
