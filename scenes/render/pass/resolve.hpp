// SPDX-License-Identifier: MIT
#pragma once
// The one pass that makes of what was drawn what effects read: planar distance of reversed depth, and of several
// samples one of each kind. Not for display pictures, whose samples the attachment itself averages.

#include <memory>
#include <vector>

#include "gpu/kernel/kernel.hpp"
#include "render/targets.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

class Resolve {
  public:
    [[nodiscard]] static Result<Resolve> create(gpu::Context& context, const TargetFormats& formats,
                                                std::uint32_t slots);
    [[nodiscard]] ResolveUse use() const;
    /// Writes what the shader needs of camera and targets; slot `slot` is not in use by the device.
    void prepare(const scene::CameraState& camera, const Targets& targets, std::uint32_t slot);
    /// Any number of times behind prepare().
    void record(VkCommandBuffer commands, const Targets& targets, std::uint32_t slot) const;

  private:
    gpu::Context* context_ = nullptr;
    std::unique_ptr<gpu::Kernel> kernel_;
    gpu::DescriptorSets sets_;
    gpu::Buffer blocks_;  ///< a pass block a slot
    VkDeviceSize block_stride_ = 0;
};

}  // namespace darkroom::render
