// SPDX-License-Identifier: MIT
#pragma once
// What lies behind the scene and under it: the skybox on the far plane, kept HDR and with the camera's motion, and the
// grid of 40 x 40 m on y = 0.

#include "render/frame_set.hpp"

namespace darkroom::render {

class SkyPass {
  public:
    [[nodiscard]] static Result<SkyPass> create(gpu::Context& context, const PassSetup& setup);
    /// Drawn after opaque geometry: it fills what the depth says is far. Without a skybox the background colour.
    void record_sky(VkCommandBuffer commands, VkDescriptorSet frame_set) const;
    void record_grid(VkCommandBuffer commands, VkDescriptorSet frame_set) const;

  private:
    gpu::Pipeline sky_, grid_;
};

}  // namespace darkroom::render
