// SPDX-License-Identifier: MIT
#pragma once
// Where the cascades of a directional light lie: practical splits (Zhang et al., "Parallel-Split Shadow Maps", 2006),
// a bounding sphere a slice snapped to texels, so that edges stand still when the camera moves, and a depth range
// extended toward the light, so that walls and ceilings behind the camera cast. Arithmetic alone, no GPU.

#include <array>
#include <cstdint>

#include "render/frame_set.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

/// The last part of each cascade that is blended into the next, which covers it too; shaders/light/shadow.glsl has it
/// as well.
inline constexpr float cascade_blend = 0.1F;

struct CascadeDesc {
    std::uint32_t count = 3;          ///< [1, 4]
    std::uint32_t resolution = 2048;  ///< of each, texels
    float split_lambda = 0.5F;        ///< 0 uniform .. 1 logarithmic
    float far_distance = 200;         ///< where shadows end, metres
    float least_pull_back = 100;      ///< how far behind the view casters are looked for, metres
};

struct Cascades {
    std::uint32_t count = 0;
    std::array<scene::mat4, most_cascades> world_to_cascade{};  ///< see shaders/light/shadow_block.glsl
    std::array<float, most_cascades> splits{};                  ///< far view distance of each
    std::array<float, most_cascades> texel{};                   ///< world size of a texel
};

/// Far distances of the slices; near 0.1, far 200, lambda 0.5, 3 cascades: 33.997, 74.620, 200.
[[nodiscard]] std::array<float, most_cascades> practical_splits(float near_distance, float far_distance, float lambda,
                                                                std::uint32_t count);

/// `toward_light`: normalised, any direction, straight up too.
[[nodiscard]] Cascades fit_cascades(const scene::CameraState& camera, scene::vec3 toward_light,
                                    const CascadeDesc& desc);

}  // namespace darkroom::render
