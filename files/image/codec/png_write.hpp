// SPDX-License-Identifier: MIT
#pragma once
// Internal to files/image: display-encoded samples made into a PNG file in memory (ISO/IEC 15948), deflated by
// libdeflate: four to six times as fast as libpng with zlib, and no larger. It says that the samples are sRGB, where
// they are, or what else they are.

#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <optional>
#include <vector>

#include "core/primaries.hpp"

namespace darkroom {

struct PngDesc {
    std::uint32_t width = 0, height = 0;
    std::uint32_t channels = 3;     ///< 3, or 4 with alpha
    std::uint32_t bytes = 1;        ///< of a sample, 1 or 2, in the order of this machine
    const void* samples = nullptr;  ///< rows from the top
    bool is_srgb = true;            ///< false: the file says nothing of its colour, but for what comes next
    /// Primaries and curve by ITU-T H.273, in place of sRGB.
    std::optional<std::array<std::uint8_t, 2>> video_codes{};
    /// Beside that an ICC profile, for those who do not know these numbers; empty: none.
    std::vector<std::byte> profile{};
    /// Of PQ, in cd/m2: the display that it is made for, the brightest component of a pixel, and the mean of each pixel's
    /// brightest (CTA-861.3, MaxCLL and MaxFALL). Without them browsers take the brightest that PQ holds for the picture's.
    struct Light {
        Chromaticities primaries;
        double display_peak = 0, max = 0, mean = 0;
    };
    std::optional<Light> light{};
    std::optional<int> level;  ///< of libdeflate, 0 to 12; not given: fast, and better where that costs little
};

[[nodiscard]] Result<std::vector<std::byte>> encode_png(const PngDesc& desc);

}  // namespace darkroom
