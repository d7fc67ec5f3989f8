// SPDX-License-Identifier: MIT
#pragma once
// Lens distortion: bends the picture as a lens does, into a barrel or a pincushion, each colour by a little more or
// less. It bends what was made; it does not see more of the scene than the camera did.

#include <vulkan/vulkan.h>

#include <darkroom/warp_grid.hpp>

namespace darkroom {

struct EffectInfo;

/// Where the bend is worked out: in every pixel, or in the vertices of a grid, between which it is interpolated.
enum class LensDistortionEvaluation : std::uint32_t { Pixel, Vertex };

struct LensDistortion {
    /// Coefficient of the squared distance from the centre: above 0 a barrel, below 0 a pincushion. [-0.3, 1]
    float lens_distortion = 0.0f;
    /// Coefficient of the fourth power of that distance; it bends mainly the corners. [-0.2, 1]
    float quartic = 0.0f;
    /// Amount added to the first coefficient for red and taken from it for blue: coloured fringes. [-0.1, 0.1]
    float dispersion = 0.0f;
    /// Scales the picture so that it just fills its frame.
    Toggle fill = true;
    /// Place where the bend is computed: every pixel, or the vertices of a grid with interpolation between them.
    LensDistortionEvaluation evaluation = LensDistortionEvaluation::Pixel;
    /// Columns and rows of the grid whose vertices are evaluated. [1, 256]
    Vec2 grid = default_warp_grid;
};

/// r' = scale * r (1 + k r^2 + quartic r^4), with r = 1 in a corner: where green is read for the pixel at r. For red
/// `dispersion` is added to k, for blue it is taken from it.
struct LensDistortionWay {
    std::array<float, 2> half_size{};  ///< of the picture, where its half diagonal is 1
    float half_diagonal = 0;           ///< in pixels
    float scale = 1;
};
[[nodiscard]] LensDistortionWay lens_distortion_way(const LensDistortion& lens, VkExtent2D extent);

[[nodiscard]] const EffectInfo& effect_info(const LensDistortion&);

}  // namespace darkroom
