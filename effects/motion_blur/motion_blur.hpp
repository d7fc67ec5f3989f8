// SPDX-License-Identifier: MIT
#pragma once
// Motion blur: what moves while the shutter is open smears along its way, by the velocity of every pixel. It knows one
// frame: what was hidden behind a moving thing is guessed from beside it, and ways are straight.

#include <vulkan/vulkan.h>

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class MotionBlurResolution : std::uint32_t { Half, Full };

struct MotionBlur {
    /// Time that the shutter is open: 360 is the whole time from frame to frame. [0, 720] deg
    float shutter_angle = 180.0f;
    /// Largest distance that a point smears to either side, in hundredths of the picture's height. [0.1, 3]
    float max_radius = 3.0f;
    /// Number of points along the way that a pixel reads; an odd number counts as one less. [2, 64]
    std::int32_t samples = 12;
    /// Size of the smeared picture, as a share of each side.
    MotionBlurResolution resolution = MotionBlurResolution::Half;
};

/// Side of the square tiles whose fastest motion is known, in pixels, for pictures of at most this extent: a multiple
/// of 8, and at least the farthest that a point smears.
[[nodiscard]] std::uint32_t motion_blur_tile(VkExtent2D extent);

[[nodiscard]] const EffectInfo& effect_info(const MotionBlur&);

}  // namespace darkroom
