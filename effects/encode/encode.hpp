// SPDX-License-Identifier: MIT
#pragma once
// Encode: turns linear light into the code values that a display or a file expects. It is done once, last but for
// dither; it compresses nothing: tone map before it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class TransferFunction : std::uint32_t {
    Srgb,     ///< IEC 61966-2-1, piecewise
    Gamma22,  ///< a plain power
    Pq,       ///< SMPTE ST 2084 in Rec. 2020 primaries; 1.0 is 10000 cd/m2
    Scrgb,    ///< linear Rec. 709; 1.0 is 80 cd/m2
    None,
    Hlg,  ///< ARIB STD-B67 in Rec. 2020 primaries; 1.0 is peak_nits
    P3,   ///< the curve of Srgb in P3 primaries
};

struct Encode {
    /// Encoding of the display or file that the picture is for: transfer function and primaries.
    TransferFunction transfer = TransferFunction::Srgb;
    /// Luminance of linear 1.0; only pq, hlg and scrgb use it. [1, 10000] cd/m2
    float white_nits = 203.0f;
    /// Luminance at which each channel is clipped; only pq, hlg and scrgb use it. [1, 10000] cd/m2
    float peak_nits = 1000.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Encode&);

}  // namespace darkroom
