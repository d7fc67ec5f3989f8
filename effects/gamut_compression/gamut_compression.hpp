// SPDX-License-Identifier: MIT
#pragma once
// Gamut compression: brings colours that a display's primaries cannot make into what they can, and leaves those alone
// that are not near its edge. It compresses no brightness: tone map behind it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class GamutCompressionInto : std::uint32_t { Rec709, P3, Rec2020 };

struct GamutCompression {
    /// Primaries of the display that the colours are made for.
    GamutCompressionInto into = GamutCompressionInto::Rec709;
    /// Distances from grey, towards cyan, magenta and yellow, that are moved to the edge of the gamut. [1.001, 8]
    Vec3 limit{1.147f, 1.264f, 1.312f};
    /// Distances from grey up to which colours stay as they are; the edge is at 1. [0, 0.99]
    Vec3 threshold{0.815f, 0.803f, 0.88f};
    /// Sharpness of the curve's bend: a larger value keeps more colours as they are and separates the others less. [1,
    /// 8]
    float power = 1.2f;
};

[[nodiscard]] const EffectInfo& effect_info(const GamutCompression&);

}  // namespace darkroom
