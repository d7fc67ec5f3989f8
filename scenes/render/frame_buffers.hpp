// SPDX-License-Identifier: MIT
#pragma once
// What the host writes for a frame and the shaders read as set 0: blocks, instances, materials, joints, weights. One
// FrameBuffers for each frame in flight; buffers grow when a frame needs more than any before it.

#include <vulkan/vulkan.h>

#include <array>
#include <span>
#include <vector>

#include "gpu/device/context.hpp"
#include "render/light/environment.hpp"
#include "render/shadow/shadow_pass.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

// Descriptor sets whose number is not known beforehand: pools are added as they are needed, and all go together.

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

/// An error if a storage buffer of this size is more than shaders of the device can reach.
[[nodiscard]] Result<> check_storage(const gpu::Context& context, VkDeviceSize size, std::string_view name);

/// Memory that the host writes and shaders read.
class HostBuffer {
  public:
    /// At least so many bytes; what was there is lost where it grows.
    Result<> reserve(gpu::Context& context, VkDeviceSize size, VkBufferUsageFlags usage, std::string_view name);
    template <class T>
    [[nodiscard]] T* as() const {
        return reinterpret_cast<T*>(buffer_.memory.mapped);
    }
    [[nodiscard]] VkDescriptorBufferInfo info() const { return {buffer_.handle, 0, VK_WHOLE_SIZE}; }

  private:
    gpu::Buffer buffer_;
    VkDeviceSize capacity_ = 0;
};

class FrameBuffers {
  public:
    struct Counts {
        std::size_t instances = 0, materials = 0, joints = 0, weights = 0;
    };
    FrameBuffers() = default;
    FrameBuffers(FrameBuffers&&) = default;

    /// `sets` outlives it.
    [[nodiscard]] static Result<FrameBuffers> create(gpu::Context& context, SetAllocator& sets,
                                                     VkDescriptorSetLayout layout);
    /// Makes room for so many.
    Result<> reserve(gpu::Context& context, const Counts& counts);
    /// Points the set at the buffers as they are now. The set is not in use by the device.
    void write_set(const gpu::Context& context, const GpuScene& scene, const ShadowPass& shadows,
                   const GpuEnvironment& environment) const;

    /// Before reserve(): room for so many frame blocks beside the frame's own, which use_position() puts in its place.
    Result<> reserve_positions(gpu::Context& context, std::size_t count);
    [[nodiscard]] blocks::Frame& position(std::size_t index) const { return positions_.as<blocks::Frame>()[index]; }
    /// Outside rendering: what is drawn from here on, and nothing before, sees this block.
    void use_position(const gpu::Context& context, VkCommandBuffer commands, std::size_t index) const;

    [[nodiscard]] blocks::Frame& frame() const { return *frame_.as<blocks::Frame>(); }
    [[nodiscard]] blocks::Lights& lights() const { return *lights_.as<blocks::Lights>(); }
    [[nodiscard]] blocks::Shadows& shadows() const { return *shadows_.as<blocks::Shadows>(); }
    [[nodiscard]] blocks::Instance* instances() const { return instances_.as<blocks::Instance>(); }
    [[nodiscard]] blocks::Material* materials() const { return materials_.as<blocks::Material>(); }
    [[nodiscard]] scene::mat4* joints() const { return joints_.as<scene::mat4>(); }    ///< two a joint: now, before
    [[nodiscard]] scene::vec2* weights() const { return weights_.as<scene::vec2>(); }  ///< now, before

    VkDescriptorSet set = VK_NULL_HANDLE;

  private:
    HostBuffer frame_, positions_, lights_, shadows_, instances_, materials_, joints_, weights_;
};

/// Descriptors of one set of create_frame_layout().
[[nodiscard]] std::array<VkDescriptorPoolSize, 3> frame_set_sizes();

}  // namespace darkroom::render
