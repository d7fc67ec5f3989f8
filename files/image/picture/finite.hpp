// SPDX-License-Identifier: MIT
#pragma once
// Pixels of files that are no numbers.

#include <cstddef>
#include <cstdint>
#include <span>

#include "image/picture/picture.hpp"

namespace darkroom {

/// Pixels that were not finite, and are now: NaN became 0, an infinity +-65504 (the largest half); alpha 1.
struct PixelCounts {
    std::size_t nan_color = 0;
    std::size_t infinite_color = 0;
    std::size_t nan_alpha = 0;
    std::size_t infinite_alpha = 0;
    /// Normals and motion (became 0), depth that is NaN (became sky), depth of shadows (became 1, which is lit).
    std::size_t not_finite_other = 0;
    [[nodiscard]] bool operator==(const PixelCounts&) const = default;
};

[[nodiscard]] inline bool is_finite_half(std::uint16_t half) { return (half & 0x7c00u) != 0x7c00u; }

/// Mends pixels of red, green, blue and alpha, and counts them.
void make_finite(std::span<std::uint16_t> halves, PixelCounts& counts);
void make_finite(Picture& color, PixelCounts& counts);

}  // namespace darkroom
