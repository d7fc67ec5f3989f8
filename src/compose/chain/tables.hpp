// SPDX-License-Identifier: MIT
#pragma once
// The constant images of a chain: tables of effects and 1x1 neutral ones. Made at compile, uploaded by the first
// recording, never written again.

#include <optional>
#include <span>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

class Tables {
  public:
    [[nodiscard]] static Result<Tables> create(gpu::Context& context, std::span<const plan::FixedImage> images);
    /// The first time: copies and barriers. Later: nothing. `recording` is the number of the recording it is for.
    void upload(VkCommandBuffer commands, std::uint64_t recording);
    /// That recording will not be submitted: what it uploaded is uploaded again.
    void take_back(std::uint64_t recording);
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
    std::optional<std::uint64_t> uploaded_by_;
};

/// Stands in for the shadow map of a light that a frame does not have: lit everywhere.
class LitShadowMap {
  public:
    LitShadowMap() = default;
    [[nodiscard]] static Result<LitShadowMap> create(gpu::Context& context);
    /// The first time, records its clearing. Does nothing for one that was not created.
    void upload(VkCommandBuffer commands, std::uint64_t recording);
    void take_back(std::uint64_t recording);
    ImageRef reference;

  private:
    gpu::Image image_;
    std::optional<std::uint64_t> uploaded_by_;
};

}  // namespace darkroom::compose
