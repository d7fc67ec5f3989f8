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
    /// Focuses on what is seen at `autofocus_place`; `focus_distance` then does not count.
    Toggle autofocus = false;
    /// Place in the picture that the lens focuses on: (0, 0) is the top left, (1, 1) the bottom right. [0, 1]
    Vec2 autofocus_place{0.5f, 0.5f};
    /// Speed of the lens toward another distance, in dioptres (1/m); at 0 it stays. [0, 100] 1/m/s
    float autofocus_speed = 2.0f;
    /// Focal length divided by the aperture's diameter: a smaller number blurs more. [0.5, 64]
    float f_stop = 2.8f;
    /// Height of the sensor; with the field of view it gives the focal length. [1, 1000] mm
    float sensor_height = 24.0f;
    /// Largest radius of the circle of confusion, in hundredths of the picture's height. [0.1, 4]
    float max_radius = 2.0f;
    /// Number of the aperture's blades; fewer than 3 make a round aperture. [0, 11]
    std::int32_t blades = 0;
    /// Bend of the blades' straight sides: 0 is a polygon, 1 a circle. [0, 1]
    float roundness = 0.0f;
    /// Angle by which the aperture is turned, counterclockwise. [-180, 180] deg
    float rotation = 0.0f;
    /// Height of the circle of confusion divided by its width. [1, 2]
    float anamorphic_ratio = 1.0f;
    /// Share by which the barrel of the lens cuts circles in the corners. [0, 1]
    float cats_eye = 0.0f;
    /// Number of sample rings for a pixel: n rings are 4 n (n + 1) samples. [2, 8]
    std::int32_t rings = 4;
    /// Size of the blurred picture, as a share of each side.
    DepthOfFieldResolution resolution = DepthOfFieldResolution::Half;
};

[[nodiscard]] const EffectInfo& effect_info(const DepthOfField&);

}  // namespace darkroom
