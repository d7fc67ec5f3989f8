// SPDX-License-Identifier: MIT
#pragma once
// A second picture in a JPEG file, which makes the first one brighter: ISO 21496-1:2025, and Android's "Ultra HDR Image
// Format" (2023), whose numbers are XMP of Adobe's hdrgm.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/primaries.hpp"

namespace darkroom {

/// Of one channel. Gains are in stops.
struct GainRange {
    double min = 0, max = 1, gamma = 1;
    double base_offset = 1.0 / 64, brighter_offset = 1.0 / 64;
};

struct GainMap {
    std::array<GainRange, 3> ranges;
    std::span<const std::byte> picture;  ///< a JPEG stream
    Chromaticities base, result;         ///< of the first picture's light, and of the light that comes out
    std::string_view said;               ///< by what it says its numbers
};

/// What a file says of light beyond white.
struct FoundGainMap {
    std::optional<GainMap> map;  ///< none: there is none, or it is not applied
    std::string why_not;         ///< a reason for which it is not; empty: there is none, or it is applied
};
[[nodiscard]] FoundGainMap find_gain_map(std::span<const std::byte> file);

/// The pixels of a map, for the first picture's rows. Light is made by all of the gain, as for a display that has room
/// for it.
class GainRows {
  public:
    /// `samples`: 1 or 3 a pixel.
    GainRows(const GainMap& map, std::vector<std::uint8_t> samples, std::uint32_t width, std::uint32_t height);
    /// Linear light of the first picture's row in RGB to light, in place.
    void apply(std::span<float> rgb, std::uint32_t row, std::uint32_t height) const;

  private:
    GainMap map_;
    std::optional<ColorMatrix> to_result_;
    std::vector<std::uint8_t> samples_;
    std::uint32_t width_ = 0, height_ = 0;
    std::size_t channels_ = 1;
};

}  // namespace darkroom
