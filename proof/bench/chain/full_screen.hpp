// SPDX-License-Identifier: MIT
#pragma once
// A raster pipeline of a full-screen triangle, made from Vulkan alone, for what is measured beside the library.

#include <span>

#include "gpu/device/dispatch.hpp"

namespace darkroom::bench {

struct FullScreenPipeline {
    VkPipelineLayout layout = VK_NULL_HANDLE;
    std::span<const VkPipelineShaderStageCreateInfo> stages;
    VkFormat output = VK_FORMAT_UNDEFINED;
    VkPipelineColorBlendAttachmentState blend{};
};
/// Viewport and scissor are dynamic.
[[nodiscard]] VkResult create_full_screen_pipeline(const gpu::Dispatch& vk, VkDevice device, VkPipelineCache cache,
                                                   const FullScreenPipeline& wanted, VkPipeline& pipeline);

}  // namespace darkroom::bench
