// SPDX-License-Identifier: MIT
#include "render/upload/gpu_scene_sets.hpp"

namespace darkroom::render {

SetAllocator::SetAllocator(gpu::Context& context, std::span<const VkDescriptorPoolSize> sizes,
                           std::uint32_t sets_a_pool)
    : context_(&context), sizes_(sizes.begin(), sizes.end()), sets_a_pool_(sets_a_pool) {
    for (VkDescriptorPoolSize& size : sizes_) size.descriptorCount *= sets_a_pool;
}

SetAllocator::~SetAllocator() {
    for (const VkDescriptorPool pool : pools_)
        context_->vk.DestroyDescriptorPool(context_->device, pool, context_->allocator);
}

Result<> SetAllocator::add_pool() {
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = sets_a_pool_,
                                          .poolSizeCount = static_cast<std::uint32_t>(sizes_.size()),
                                          .pPoolSizes = sizes_.data()};
    // No exception comes between the pool and its place.
    pools_.reserve(pools_.size() + 1);
    VkDescriptorPool pool = VK_NULL_HANDLE;
    DARKROOM_TRY(context_->check(context_->vk.CreateDescriptorPool(context_->device, &info, context_->allocator, &pool),
                                 "creating a pool of the scene's descriptor sets"));
    pools_.push_back(pool);
    left_ = sets_a_pool_;
    return {};
}

Result<VkDescriptorSet> SetAllocator::allocate(VkDescriptorSetLayout layout) {
    if (left_ == 0) DARKROOM_TRY(add_pool());
    const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = pools_.back(),
                                           .descriptorSetCount = 1,
                                           .pSetLayouts = &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    DARKROOM_TRY(context_->check(context_->vk.AllocateDescriptorSets(context_->device, &info, &set),
                                 "allocating a descriptor set of the scene"));
    --left_;
    return set;
}

}  // namespace darkroom::render
