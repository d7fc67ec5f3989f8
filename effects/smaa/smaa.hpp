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
    /// How far the ends of an edge are searched.
    SmaaQuality quality = SmaaQuality::High;
    /// What is compared to find edges.
    SmaaDetection detection = SmaaDetection::Luma;
    /// Difference of code values, or of their luma, that makes an edge. [0.02, 0.5]
    float threshold = 0.1f;
    /// An edge beside one so many times stronger is none: what is seen is the stronger one. [1, 8]
    float contrast = 2.0f;
    /// How much of what an edge takes off a corner it takes: 0 keeps corners as they are, 1 rounds them. [0, 1]
    float corner_rounding = 0.25f;
    /// How much lower the threshold is where the frame's depth jumps, and how much higher elsewhere; 0 reads no
    /// depth. [0, 1]
    float predication = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Smaa&);

}  // namespace darkroom
