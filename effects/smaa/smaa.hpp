// SPDX-License-Identifier: MIT
#pragma once
// Subpixel morphological anti-aliasing, 1x: smooths the stairs of edges in the finished picture by the line that each
// stair stands for. It knows the picture alone, so it cannot mend what flickers or what was never drawn; but it leaves
// all that is no edge as it is, and corners sharp.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// How far the ends of an edge are searched: along lines, and along diagonals, in pixels to either side.
enum class SmaaQuality : std::uint32_t {
    Low,     ///< 8, and no diagonals
    Medium,  ///< 16, and no diagonals
    High,    ///< 32 and 8
    Ultra,   ///< 64 and 16
};

enum class SmaaDetection : std::uint32_t {
    Luma,   ///< by luma
    Color,  ///< by the channel that differs most: finds edges between colours of one luma, too
};

struct Smaa {
    /// Length of the search for the ends of an edge.
    SmaaQuality quality = SmaaQuality::High;
    /// Quantity that is compared to find edges.
    SmaaDetection detection = SmaaDetection::Luma;
    /// Difference of code values, or of their luma, that makes an edge. [0.02, 0.5]
    float threshold = 0.1f;
    /// Ratio to a stronger neighbouring edge at which an edge is dropped. [1, 8]
    float contrast = 2.0f;
    /// Share of the smoothing that corners get: 0 keeps corners as they are, 1 rounds them. [0, 1]
    float corner_rounding = 0.25f;
    /// Amount by which jumps of the frame's depth lower the threshold, and its absence raises it; 0 reads no depth. [0,
    /// 1]
    float predication = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Smaa&);

}  // namespace darkroom
