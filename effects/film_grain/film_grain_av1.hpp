// SPDX-License-Identifier: MIT
#pragma once
// The luma grain of AV1, bit for bit as its decoders make it: "AV1 Bitstream & Decoding Process Specification",
// Alliance for Open Media, 2019, section 7.18.3. Integers of 8, 10 or 12 bits, around 0.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace darkroom {

/// film_grain_params() as far as luma goes; names are the specification's.
struct Av1Grain {
    std::uint32_t grain_seed = 0;
    std::int32_t bit_depth = 8;
    std::int32_t grain_scale_shift = 0;
    std::int32_t ar_coeff_lag = 0;               ///< [0, 3]
    std::span<const std::int8_t> ar_coeffs_y{};  ///< 2 lag (lag + 1) of them, row by row
    std::int32_t ar_coeff_shift = 7;             ///< [6, 9]
};

inline constexpr std::int32_t av1_grain_width = 82, av1_grain_height = 73, av1_grain_block = 32;

/// LumaGrain of section 7.18.3.3, row by row.
using Av1Template = std::array<std::int16_t, std::size_t{av1_grain_width} * av1_grain_height>;
[[nodiscard]] Av1Template av1_grain_template(const Av1Grain& grain);

/// noiseImage[0] of section 7.18.3.5 for so many blocks, whose edges overlap (overlap_flag), row by row. `wraps`: it
/// may be repeated, because the first blocks overlap with the last, too.
[[nodiscard]] std::vector<std::int16_t> av1_grain_picture(const Av1Grain& grain, std::int32_t columns,
                                                          std::int32_t rows, bool wraps);

}  // namespace darkroom
