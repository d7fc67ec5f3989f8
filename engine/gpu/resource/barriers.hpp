// SPDX-License-Identifier: MIT
#pragma once
// Barriers that no graph derives: of uploads, of the renderer of scenes, of windows.

#include <vulkan/vulkan.h>

#include <span>

#include "gpu/device/context.hpp"

namespace darkroom::gpu {

struct Image;

/// What commands do with an image or a buffer. Content that is UNDEFINED is not kept.
struct Use {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

inline constexpr Use copied_to{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
inline constexpr Use copied_from{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
inline constexpr Use read_by_host{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

[[nodiscard]] VkImageMemoryBarrier2 image_barrier(VkImage, const VkImageSubresourceRange&, const Use& before,
                                                  const Use& after);
/// Of the whole image.
[[nodiscard]] VkImageMemoryBarrier2 image_barrier(const Image&, const Use& before, const Use& after);
void record_barriers(const Dispatch&, VkCommandBuffer, std::span<const VkImageMemoryBarrier2>,
                     std::span<const VkMemoryBarrier2> = {});
/// Of all memory.
void record_barrier(const Dispatch&, VkCommandBuffer, const Use& before, const Use& after);

}  // namespace darkroom::gpu
