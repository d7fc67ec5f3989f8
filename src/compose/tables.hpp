// SPDX-License-Identifier: MIT
#pragma once
// The constant images of a chain: tables of effects and 1x1 neutral ones. Made at compile, uploaded by the first
// recording, never written again.

#include <span>
#include <vector>

#include "gpu/resources.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

using namespace plan;

class Tables {
  public:
    [[nodiscard]] static Result<Tables> create(gpu::Context& context, std::span<const Constant> constants);
    /// The first time: copies and barriers. Later: nothing.
    void upload(VkCommandBuffer commands);
    [[nodiscard]] gpu::Binding binding(std::size_t index) const;

  private:
    struct Table {
        gpu::Image image;
        VkDeviceSize offset = 0;
        VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        bool is_nearest = false;
    };
    std::vector<Table> tables_;
    gpu::Buffer staging_;
    bool is_uploaded_ = false;
};

/// Stands in for the shadow map of a light that a frame does not have: lit everywhere.
class LitShadowMap {
  public:
    LitShadowMap() = default;
    [[nodiscard]] static Result<LitShadowMap> create(gpu::Context& context);
    /// The first time, records its clearing. Does nothing for one that was not created.
    void upload(VkCommandBuffer commands);
    ImageRef reference;

  private:
    gpu::Image image_;
    bool is_uploaded_ = false;
};

}  // namespace darkroom::compose
