// SPDX-License-Identifier: MIT
#pragma once
// From a snapshot to the numbers that the shaders read, and to the camera and lights of a darkroom::Frame. No GPU.

#include <darkroom/frame.hpp>
#include <span>
#include <vector>

#include "render/frame_set.hpp"
#include "render/pass/draw_list.hpp"
#include "render/shadow/lamps.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

/// What the frame block says beyond the snapshot.
struct FrameSettings {
    VkExtent2D extent{};
    std::array<float, 2> jitter{};  ///< Camera::jitter
    float mip_bias = 0;             ///< of textures
    Output output = Output::Hdr;
    bool is_tone_mapped = true;
    float exposure = 1;
    DebugView debug = DebugView::None;
    scene::Environment environment;
    std::array<scene::vec3, 9> irradiance{};
    std::uint32_t environment_levels = 1;
};

[[nodiscard]] blocks::Frame frame_block(const scene::Snapshot& snapshot, const FrameSettings& settings);
/// The same frame, drawn so that the centres of pixels see what lies `pixels` beside them, x right and y down.
[[nodiscard]] blocks::Frame moved_block(const blocks::Frame& frame, scene::vec2 pixels);
/// The same frame, seen from `place` beside the camera, x right and y up in metres; what lies `focus_distance` metres
/// away along the view axis stays where it is in the picture.
[[nodiscard]] blocks::Frame seen_from(const blocks::Frame& frame, scene::vec2 place, float focus_distance);
/// `shadow_maps`: of the first that many casting directional lights; `lamps`: those that have tiles.
[[nodiscard]] blocks::Lights light_block(const scene::Snapshot& snapshot, std::uint32_t shadow_maps,
                                         std::span<const LampTiles> lamps = {});
[[nodiscard]] blocks::Material material_block(const scene::SnapshotMaterial& material);
[[nodiscard]] blocks::Instance instance_block(const scene::Instance& instance, const GpuMesh& mesh);

[[nodiscard]] Camera frame_camera(const scene::CameraState& camera, VkExtent2D extent, const FrameJitter& jitter = {});
/// Moves clip space, so that the picture is moved by these pixels.
[[nodiscard]] scene::mat4 jitter_matrix(const std::array<float, 2>& jitter, VkExtent2D extent);
/// A directional light as effects get it, without its cascades.
[[nodiscard]] Light frame_light(const scene::LightState& light);
[[nodiscard]] Matrix matrix_of(const scene::mat4& matrix);

/// The directional lights that are drawn, in the snapshot's order.
[[nodiscard]] std::vector<const scene::LightState*> directional_lights(const scene::Snapshot& snapshot);
/// Of directional ones: has a shadow map, as ShadowPass sees it.
[[nodiscard]] bool is_caster(const scene::LightState* state);

}  // namespace darkroom::render
