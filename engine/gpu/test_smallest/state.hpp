// SPDX-License-Identifier: MIT
#pragma once
// For tests only: what the functions of the smallest device share.

#include <array>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <darkroom/log.hpp>
#include "gpu/device/dispatch.hpp"
#include "gpu/test_smallest/facts.hpp"

namespace darkroom::gpu::test {

struct SmallestState {
    Dispatch real;  ///< of the driver
    VkPhysicalDeviceLimits limits{};
    LogSink log;
    bool has_graphics = true;                   ///< its queue
    std::array<std::uint32_t, 2> real_types{};  ///< the driver's memory type for each of its two

    std::mutex mutex;  ///< guards what follows
    std::map<VkImage, VkFormat> images;
    std::map<VkImageView, VkFormat> views;
    std::map<VkSampler, bool> samplers;  ///< whether it filters
    std::set<VkSampler> comparing;
    struct MemoryFacts {
        bool has_buffers = false, has_images = false;
        std::uint32_t type = 0;
    };
    std::map<VkDeviceMemory, MemoryFacts> memories;
    std::map<VkShaderModule, std::vector<std::uint32_t>> shaders;
    std::map<VkDescriptorSetLayout, std::vector<VkDescriptorSetLayoutBinding>> set_layouts;
    std::set<VkCommandBuffer> broken;  ///< a command of it was refused
};

[[nodiscard]] SmallestState& smallest();

/// Tells whoever listens.
void refuse(const std::string& text);
/// The same, and the command buffer cannot be ended.
void refuse(VkCommandBuffer commands, const std::string& text);

/// By what name the driver's function is replaced, and by what.
using Replacements = std::map<std::string_view, PFN_vkVoidFunction>;
void replace_queries(Replacements& functions);
void replace_resources(Replacements& functions);
void replace_pipelines(Replacements& functions);
void replace_commands(Replacements& functions);

/// Destroys an object, of which no facts are then known.
template <auto facts, auto destroy, class Object>
void forget(VkDevice device, Object object, const VkAllocationCallbacks* allocator) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    (state.*facts).erase(object);
    (state.real.*destroy)(device, object, allocator);
}

template <class Function>
PFN_vkVoidFunction as_void(Function* function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

}  // namespace darkroom::gpu::test
