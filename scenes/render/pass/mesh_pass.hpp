// SPDX-License-Identifier: MIT
#pragma once
// Meshes: opaque and masked, transparent by their blend, wireframes, normal arrows, and depth alone for shadow maps.
// One vertex shader places them all (shaders/mesh/mesh_vertex.glsl), so that every pass agrees on where a vertex is.

#include <memory>

#include "render/frame_set.hpp"
#include "render/pass/draw_list.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

/// What surfaces are shown as, and what is laid over them.
struct MeshLook {
    DebugView debug = DebugView::None;
    bool has_edges = false, has_normal_arrows = false;
};

struct MeshDraw {
    VkDescriptorSet frame_set = VK_NULL_HANDLE;
    const scene::Snapshot* snapshot = nullptr;
    const DrawList* list = nullptr;
    std::uint32_t first_instance = 0;  ///< where the list's instances start in the instance buffer
    MeshLook look;
};

class MeshPass {
  public:
    [[nodiscard]] static MeshPass create(gpu::Context& context, const PassSetup& setup, const GpuScene& scene);
    /// Makes the pipelines that drawing this needs and that there are not yet.
    Result<> prepare(const MeshDraw& draw, const GpuScene& scene);
    Result<> record_opaque(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const;
    /// Edges of rooms, then the list's transparent ones.
    Result<> record_transparent(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const;
    /// What the look lays over the picture: edges of all meshes, a line along the normal of every vertex.
    Result<> record_overlays(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const;
    /// Calls made by this pass since it was created: the tests of instancing read it.
    [[nodiscard]] std::uint64_t draw_calls() const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace darkroom::render
