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
    float lens_distortion = 0.0f;
    float quartic = 0.0f;
    float dispersion = 0.0f;
    Toggle fill = true;
    LensDistortionEvaluation evaluation = LensDistortionEvaluation::Pixel;
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
