// SPDX-License-Identifier: MIT
#include "gpu/resource/barriers.hpp"

#include "gpu/resource/formats.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

namespace {

VkMemoryBarrier2 memory_barrier(const Use& before, const Use& after) {
    return {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
            .srcStageMask = before.stages,
            .srcAccessMask = before.access,
            .dstStageMask = after.stages,
            .dstAccessMask = after.access};
}

}  // namespace

VkImageMemoryBarrier2 image_barrier(VkImage image, const VkImageSubresourceRange& range, const Use& before,
                                    const Use& after) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = before.stages,
            .srcAccessMask = before.access,
            .dstStageMask = after.stages,
            .dstAccessMask = after.access,
            .oldLayout = before.layout,
            .newLayout = after.layout,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image,
            .subresourceRange = range};
}

VkImageMemoryBarrier2 image_barrier(const Image& image, const Use& before, const Use& after) {
    const VkImageSubresourceRange whole{format_traits(image.info.format).aspects, 0, VK_REMAINING_MIP_LEVELS, 0,
                                        VK_REMAINING_ARRAY_LAYERS};
    return image_barrier(image.handle, whole, before, after);
}

void record_barriers(const Dispatch& vk, VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                     std::span<const VkMemoryBarrier2> memory) {
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = static_cast<std::uint32_t>(memory.size()),
                                      .pMemoryBarriers = memory.data(),
                                      .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
                                      .pImageMemoryBarriers = images.data()};
    vk.CmdPipelineBarrier2(commands, &dependency);
}

void record_barrier(const Dispatch& vk, VkCommandBuffer commands, const Use& before, const Use& after) {
    const VkMemoryBarrier2 memory = memory_barrier(before, after);
    record_barriers(vk, commands, {}, {&memory, 1});
}

void transition(const Context& context, VkCommandBuffer commands, const Image& image, VkImageLayout from,
                VkImageLayout to) {
    constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const VkImageMemoryBarrier2 change =
        image_barrier(image, {all, VK_ACCESS_2_MEMORY_WRITE_BIT, from},
                      {all, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, to});
    const VkMemoryBarrier2 to_host = memory_barrier(copied_to, read_by_host);
    const bool was_read = from == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    record_barriers(context.vk, commands, {&change, 1}, {&to_host, was_read ? 1u : 0u});
}

}  // namespace darkroom::gpu
