// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a frame that a host drops. Not part of the library.

#include "compose/test_stacks/host.hpp"

namespace darkroom::test {

/// Recorded, and never submitted.
inline void record_in_vain(Composer& composer, const Host& host, const Frame& frame) {
    const gpu::Context& context = host.device.context();
    const gpu::Dispatch& vk = context.vk;
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .queueFamilyIndex = context.queue_family};
    VkCommandPool pool = VK_NULL_HANDLE;
    must(context.check(vk.CreateCommandPool(context.device, &pool_info, nullptr, &pool), "a pool"));
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    must(context.check(vk.AllocateCommandBuffers(context.device, &info, &commands), "commands"));
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    must(context.check(vk.BeginCommandBuffer(commands, &begin), "begin"));
    must(composer.record(commands, frame));
    must(context.check(vk.EndCommandBuffer(commands), "end"));
    vk.DestroyCommandPool(context.device, pool, nullptr);
}

}  // namespace darkroom::test
