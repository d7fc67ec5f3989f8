// SPDX-License-Identifier: MIT
#pragma once
// Recursive blend: every frame is mixed with the result of the frame before, so what moves leaves a trail that fades
// for ever. It costs one picture of memory however long the trail is. It knows no motion: for streaks along it there is
// motion_blur, for a trail with an end frame_blend.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class RecursiveBlendPrecision : std::uint32_t {
    Float,     ///< 32 bits: trails fade to nothing
    EightBit,  ///< rounded to 256 steps in [0, 1] in every frame: trails stop fading and leave a ghost
};

struct RecursiveBlend {
    /// Share of the past that remains after 1/60 s. [0, 0.99]
    float weight = 0.8f;
    /// Format that keeps the past: 32-bit floats, or 8 bits that leave a ghost.
    RecursiveBlendPrecision precision = RecursiveBlendPrecision::Float;
};

[[nodiscard]] const EffectInfo& effect_info(const RecursiveBlend&);

}  // namespace darkroom
