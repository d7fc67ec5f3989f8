// SPDX-License-Identifier: MIT
#pragma once
// Depth of field: what lies before or behind the distance that the lens is focused at is seen as circles, by the thin
// lens. It knows one frame: what a near thing hides is guessed from around it, and transparent things have no depth.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class DepthOfFieldResolution : std::uint32_t { Half, Full };

struct DepthOfField {
    /// Distance along the view axis that is sharp. [0.01, 100000] m
    float focus_distance = 5.0f;
    /// Focal length over the aperture's diameter: smaller is a wider aperture. [0.5, 64]
    float f_stop = 2.8f;
    /// Height of what the picture falls on: with the field of view it gives the focal length. [1, 1000] mm
    float sensor_height = 24.0f;
    /// Largest radius of a circle, in hundredths of the picture's height. [0.1, 4]
    float max_radius = 2.0f;
    /// Straight sides of the aperture; fewer than 3 make a round one. [0, 11]
    std::int32_t blades = 0;
    /// How far the blades' sides are bent into a circle. [0, 1]
    float roundness = 0.0f;
    /// Turns the aperture, counterclockwise. [-180, 180] deg
    float rotation = 0.0f;
    /// Height of a circle over its width. [1, 2]
    float anamorphic_ratio = 1.0f;
    /// How much the barrel of the lens cuts circles in the corners. [0, 1]
    float cats_eye = 0.0f;
    /// Rings of samples about a pixel: n of them are 4 n (n + 1) samples. [2, 8]
    std::int32_t rings = 4;
    /// Size of the picture that is blurred, in each direction.
    DepthOfFieldResolution resolution = DepthOfFieldResolution::Half;
};

[[nodiscard]] const EffectInfo& effect_info(const DepthOfField&);

}  // namespace darkroom
