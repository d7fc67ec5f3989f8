// SPDX-License-Identifier: MIT
#include "render/frame_buffers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/resource/barriers.hpp"

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

Result<> check_storage(const gpu::Context& context, VkDeviceSize size, std::string_view name) {
    if (size <= context.traits.max_storage_range) return {};
    return user_error(fmt::format("the scene is too large for {}: {} need {} bytes, shaders reach {}",
                                  context.info.name, name, size, context.traits.max_storage_range));
}

Result<> HostBuffer::reserve(gpu::Context& context, VkDeviceSize size, VkBufferUsageFlags usage,
                             std::string_view name) {
    if (size <= capacity_) return {};
    VkDeviceSize wanted = std::max(size, capacity_ + capacity_ / 2);
    if ((usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0) {
        DARKROOM_TRY(check_storage(context, size, name));
        wanted = std::min(wanted, context.traits.max_storage_range);
    }
    DARKROOM_TRY_VALUE(buffer_, gpu::Buffer::create(context, wanted, usage, gpu::Memory::Kind::Upload, name));
    capacity_ = wanted;
    return {};
}

std::array<VkDescriptorPoolSize, 3> frame_set_sizes() {
    return {VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3},
            VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 5},
            VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, shadow_images + 3}};
}

Result<FrameBuffers> FrameBuffers::create(gpu::Context& context, SetAllocator& sets, VkDescriptorSetLayout layout) {
    FrameBuffers out;
    DARKROOM_TRY_VALUE(out.set, sets.allocate(layout));
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    Result<> made =
        out.frame_.reserve(context, sizeof(blocks::Frame), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, "frame block");
    if (made) made = out.lights_.reserve(context, sizeof(blocks::Lights), usage, "light block");
    if (made) made = out.shadows_.reserve(context, sizeof(blocks::Shadows), usage, "shadow block");
    if (!made) return failure(std::move(made));
    return out;
}

Result<> FrameBuffers::reserve_positions(gpu::Context& context, std::size_t count) {
    return positions_.reserve(context, count * sizeof(blocks::Frame), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                              "frame blocks of positions");
}

void FrameBuffers::use_position(const gpu::Context& context, VkCommandBuffer commands, std::size_t index) const {
    constexpr VkPipelineStageFlags2 readers =
        VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    gpu::record_barrier(context.vk, commands, {readers | VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                        gpu::copied_to);
    const VkBufferCopy copy{index * sizeof(blocks::Frame), 0, sizeof(blocks::Frame)};
    context.vk.CmdCopyBuffer(commands, positions_.info().buffer, frame_.info().buffer, 1, &copy);
    gpu::record_barrier(context.vk, commands, gpu::copied_to, {readers, VK_ACCESS_2_UNIFORM_READ_BIT});
}

Result<> FrameBuffers::reserve(gpu::Context& context, const Counts& counts) {
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    // A binding cannot be empty, so there is room for one of each.
    const auto bytes = [](std::size_t count, std::size_t size) { return std::max<std::size_t>(count, 1) * size; };
    Result<> made = instances_.reserve(context, bytes(counts.instances, sizeof(blocks::Instance)), usage, "instances");
    if (made) made = materials_.reserve(context, bytes(counts.materials, sizeof(blocks::Material)), usage, "materials");
    if (made) made = joints_.reserve(context, bytes(counts.joints, 2 * sizeof(scene::mat4)), usage, "joints");
    if (made) made = weights_.reserve(context, bytes(counts.weights, sizeof(scene::vec2)), usage, "morph weights");
    return made;
}

void FrameBuffers::write_set(const gpu::Context& context, const GpuScene& scene, const ShadowPass& shadows,
                             const GpuEnvironment& environment) const {
    const std::array buffers{frame_.info(),     lights_.info(),
                             shadows_.info(),   instances_.info(),
                             materials_.info(), joints_.info(),
                             weights_.info(),   VkDescriptorBufferInfo{scene.morph_deltas.handle, 0, VK_WHOLE_SIZE}};
    constexpr VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    std::array<VkDescriptorImageInfo, shadow_images + 3> images{};
    for (std::uint32_t light = 0; light < max_directional_lights; ++light)
        images[light] = {shadows.sampler(), shadows.map(light).view, layout};
    images[max_directional_lights] = {shadows.sampler(), shadows.atlas().view, layout};
    images[5] = {environment.sampler, environment.prefiltered.view, layout};
    images[6] = {environment.sampler, environment.skybox.view, layout};
    images[7] = {environment.sampler, environment.split_sum.view, layout};

    std::array<VkWriteDescriptorSet, frame_bindings> writes{};
    for (std::uint32_t binding = 0; binding < frame_bindings; ++binding) {
        VkWriteDescriptorSet& write = writes[binding];
        write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = set,
                 .dstBinding = binding,
                 .descriptorCount = 1};
        if (binding < buffers.size()) {
            write.descriptorType = binding < 3 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo = &buffers[binding];
            continue;
        }
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        const bool are_maps = binding == buffers.size();
        write.descriptorCount = are_maps ? shadow_images : 1;
        write.pImageInfo = are_maps ? images.data() : &images[binding - buffers.size() + shadow_images - 1];
    }
    context.vk.UpdateDescriptorSets(context.device, frame_bindings, writes.data(), 0, nullptr);
}

}  // namespace darkroom::render
