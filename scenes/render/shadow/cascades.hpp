// SPDX-License-Identifier: MIT
#pragma once
// Where the cascades of a directional light lie: practical splits (Zhang et al., "Parallel-Split Shadow Maps", 2006) of
// the part of the view in which there is something, a bounding sphere a slice, cut to what the scene covers as the
// light sees it, and snapped to texels, so that edges stand still when the camera moves. Arithmetic alone, no GPU.

#include <array>
#include <cstdint>

#include "render/frame_set.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

/// The last part of each cascade that is blended into the next, which covers it too; shaders/light/shadow.glsl has it
/// as well.
inline constexpr float cascade_blend = 0.1F;

/// How shadows end: over a texel or two, or the wider the farther away what casts them is, as in the sun's light.
enum class ShadowFilter : std::uint32_t { Plain, Soft };

/// What a penumbra grows to either side by distance, and how many texels at most; shaders/light/shadow.glsl has them
/// too.
inline constexpr float sun_tangent = 0.004625F, max_penumbra = 8;

struct CascadeDesc {
    std::uint32_t count = 3;          ///< [1, 4]
    std::uint32_t resolution = 2048;  ///< of each, texels
    float split_lambda = 0.5F;        ///< 0 uniform .. 1 logarithmic
    ShadowFilter filter = ShadowFilter::Soft;
    float far_distance = 200;  ///< where shadows end, metres
};

/// What there is to cast and to receive shadows.
struct CascadeScene {
    scene::Box bounds{scene::vec3(-1e9F), scene::vec3(1e9F)};
    /// Depth begins where the scene does toward the light. Else it begins with the slice, or as far before that as the
    /// width of soft shadows depends on, and the rasteriser moves what lies before to depth 0: it casts all the same.
    bool holds_casters = false;
};

struct Cascades {
    std::uint32_t count = 0;
    std::array<scene::mat4, max_cascades> world_to_cascade{};  ///< see shaders/light/shadow_block.glsl
    std::array<float, max_cascades> splits{};                  ///< far view distance of each
    std::array<float, max_cascades> texel{};                   ///< world size of a texel
};

/// Far distances of the slices; near 0.1, far 200, lambda 0.5, 3 cascades: 33.997, 74.620, 200.
[[nodiscard]] std::array<float, max_cascades> practical_splits(float near_distance, float far_distance, float lambda,
                                                               std::uint32_t count);

/// `toward_light`: normalised, any direction, straight up too.
[[nodiscard]] Cascades fit_cascades(const scene::CameraState& camera, scene::vec3 toward_light, const CascadeDesc& desc,
                                    const CascadeScene& scene = {});

/// How far along the view axis the part of a box lies that is in view, without regard to near and far; 0: none is.
[[nodiscard]] double farthest_in_view(const scene::CameraState& camera, const scene::Box& box);

}  // namespace darkroom::render
