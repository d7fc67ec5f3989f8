// SPDX-License-Identifier: MIT
#pragma once
// Descriptor sets whose number is not known beforehand: pools are added as they are needed, and all go together.

#include <vulkan/vulkan.h>

#include <span>
#include <vector>

#include "gpu/device/context.hpp"

namespace darkroom::render {

class SetAllocator {
  public:
    /// `sizes`: descriptors of one set; a pool holds `sets_a_pool` of them.
    SetAllocator(gpu::Context& context, std::span<const VkDescriptorPoolSize> sizes, std::uint32_t sets_a_pool);
    SetAllocator(const SetAllocator&) = delete;
    SetAllocator& operator=(const SetAllocator&) = delete;
    ~SetAllocator();
    [[nodiscard]] Result<VkDescriptorSet> allocate(VkDescriptorSetLayout layout);

  private:
    Result<> add_pool();

    gpu::Context* context_;
    std::vector<VkDescriptorPoolSize> sizes_;  ///< of a pool
    std::uint32_t sets_a_pool_;
    std::vector<VkDescriptorPool> pools_;
    std::uint32_t left_ = 0;  ///< sets in the last pool
};

}  // namespace darkroom::render
