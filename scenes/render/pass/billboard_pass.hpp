// SPDX-License-Identifier: MIT
#pragma once
// Squares that face the camera: sprites, which are opaque where their texture's alpha is at least 0.5 and write depth,
// and particles: the alpha-blended ones of all emitters back to front, then the additive ones, whose order does not
// show.

#include "render/frame_set.hpp"
#include "render/upload/gpu_scene.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

class BillboardPass {
  public:
    [[nodiscard]] static Result<BillboardPass> create(gpu::Context& context, const PassSetup& setup, GpuScene& scene);
    /// Sorts and writes the squares of this frame into memory that slot `slot` owns, growing it where needed. Before
    /// the rendering instance; `slot` is not in use by the device.
    Result<> prepare(const scene::Snapshot& snapshot, GpuScene& scene, std::uint32_t slot);
    void record_sprites(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot) const;
    void record_particles(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace darkroom::render
