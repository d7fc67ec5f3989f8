// SPDX-License-Identifier: MIT
#pragma once
// Blue noise: a tile of 64 x 64 pixels whose ranks are spread evenly wherever they are cut. It repeats without a seam.

#include <array>
#include <cstdint>

namespace darkroom {

inline constexpr std::uint32_t blue_noise_size = 64;
/// 0 .. 4095, each once, row by row.
[[nodiscard]] const std::array<std::uint16_t, std::size_t{blue_noise_size} * blue_noise_size>& blue_noise_ranks();

}  // namespace darkroom
