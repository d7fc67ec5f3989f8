// SPDX-License-Identifier: MIT
#pragma once
// Gamut compression: brings colours that a display's primaries cannot make into what they can, and leaves those alone
// that are not near its edge. It compresses no brightness: tone map behind it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class GamutCompressionInto : std::uint32_t { Rec709, P3, Rec2020 };

struct GamutCompression {
    /// The primaries that are to make the colours.
    GamutCompressionInto into = GamutCompressionInto::Rec709;
    /// Distances from grey, towards cyan, magenta and yellow, that come to lie on the edge. [1.001, 8]
    Vec3 limit{1.147f, 1.264f, 1.312f};
    /// Distances up to which colours stay; the edge is at 1. [0, 0.99]
    Vec3 threshold{0.815f, 0.803f, 0.88f};
    /// How late the curve bends: more keeps more colour, and parts less of it. [1, 8]
    float power = 1.2f;
};

[[nodiscard]] const EffectInfo& effect_info(const GamutCompression&);

}  // namespace darkroom
