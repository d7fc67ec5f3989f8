// SPDX-License-Identifier: MIT
// Memory, images, buffers and samplers of the smallest device.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "gpu/resource/formats.hpp"
#include "gpu/test_smallest/state.hpp"

namespace darkroom::gpu::test {

namespace {

VkResult allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* allocator,
                         VkDeviceMemory* memory) {
    SmallestState& state = smallest();
    if (info->memoryTypeIndex > smallest_host_type) {
        refuse(fmt::format("memory type {}", info->memoryTypeIndex));
        return VK_ERROR_UNKNOWN;
    }
    if (info->allocationSize > smallest_max_allocation) {
        refuse(fmt::format("an allocation of {} bytes, beyond {}", info->allocationSize, smallest_max_allocation));
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const std::lock_guard lock(state.mutex);
    if (state.memories.size() >= state.limits.maxMemoryAllocationCount) {
        refuse(fmt::format("more than {} allocations", state.limits.maxMemoryAllocationCount));
        return VK_ERROR_TOO_MANY_OBJECTS;
    }
    VkMemoryAllocateInfo real_info = *info;
    real_info.memoryTypeIndex = state.real_types[info->memoryTypeIndex];
    const VkResult result = state.real.AllocateMemory(device, &real_info, allocator, memory);
    if (result == VK_SUCCESS) state.memories[*memory] = {.type = info->memoryTypeIndex};
    return result;
}

VkResult map_memory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                    VkMemoryMapFlags flags, void** data) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    if (state.memories[memory].type != smallest_host_type) {
        refuse("mapping memory that the CPU does not reach");
        return VK_ERROR_MEMORY_MAP_FAILED;
    }
    return state.real.MapMemory(device, memory, offset, size, flags, data);
}

void get_image_requirements(VkDevice device, const VkImageMemoryRequirementsInfo2* image,
                            VkMemoryRequirements2* requirements) {
    smallest().real.GetImageMemoryRequirements2(device, image, requirements);
    requirements->memoryRequirements.memoryTypeBits = 1U << smallest_device_type;
}

void get_buffer_requirements(VkDevice device, const VkBufferMemoryRequirementsInfo2* buffer,
                             VkMemoryRequirements2* requirements) {
    smallest().real.GetBufferMemoryRequirements2(device, buffer, requirements);
    requirements->memoryRequirements.memoryTypeBits = 1U << smallest_device_type | 1U << smallest_host_type;
}

VkResult bind_image(VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    SmallestState::MemoryFacts& facts = state.memories[memory];
    facts.has_images = true;
    if (facts.type != smallest_device_type || facts.has_buffers) {
        refuse(facts.has_buffers ? "an image beside a buffer, within bufferImageGranularity"
                                 : "an image in memory of a type that it cannot have");
        return VK_ERROR_UNKNOWN;
    }
    return state.real.BindImageMemory(device, image, memory, offset);
}

VkResult bind_buffer(VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    SmallestState::MemoryFacts& facts = state.memories[memory];
    facts.has_buffers = true;
    if (facts.has_images) {
        refuse("a buffer beside an image, within bufferImageGranularity");
        return VK_ERROR_UNKNOWN;
    }
    return state.real.BindBufferMemory(device, buffer, memory, offset);
}

VkResult create_buffer(VkDevice device, const VkBufferCreateInfo* info, const VkAllocationCallbacks* allocator,
                       VkBuffer* buffer) {
    if (info->size > smallest_max_buffer) {
        refuse(fmt::format("a buffer of {} bytes, beyond {}", info->size, smallest_max_buffer));
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return smallest().real.CreateBuffer(device, info, allocator, buffer);
}

/// What a usage needs of a format, by the specification's "Format Feature Dependent Usage Flags".
VkFormatFeatureFlags needs_of(VkImageUsageFlags usage) {
    VkFormatFeatureFlags features = 0;
    if ((usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0) features |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    if ((usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0) features |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    if ((usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0) features |= VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
    if ((usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0)
        features |= VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if ((usage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0) features |= VK_FORMAT_FEATURE_TRANSFER_SRC_BIT;
    if ((usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT) != 0) features |= VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    return features;
}

std::uint32_t max_side(const VkPhysicalDeviceLimits& limits, const VkImageCreateInfo& info) {
    if (info.imageType == VK_IMAGE_TYPE_1D) return limits.maxImageDimension1D;
    if (info.imageType == VK_IMAGE_TYPE_3D) return limits.maxImageDimension3D;
    if ((info.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) != 0) return limits.maxImageDimensionCube;
    return limits.maxImageDimension2D;
}

VkSampleCountFlags sample_counts(const VkPhysicalDeviceLimits& limits, const VkImageCreateInfo& info) {
    if ((info.usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0) return limits.storageImageSampleCounts;
    if (is_depth(info.format)) return limits.sampledImageDepthSampleCounts;
    const bool is_integer = format_traits(info.format).numeric != Numeric::Float;
    return is_integer ? limits.sampledImageIntegerSampleCounts : limits.sampledImageColorSampleCounts;
}

std::string beyond(const VkImageCreateInfo& info) {
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    const std::string name(format_name(info.format));
    const VkFormatFeatureFlags there = smallest_image_features(info.format);
    const VkFormatFeatureFlags missing = needs_of(info.usage) & ~there;
    if (there == 0) return fmt::format("an image of format {}", name);
    if (info.tiling != VK_IMAGE_TILING_OPTIMAL) return fmt::format("an image of format {} with linear tiling", name);
    if (missing != 0) return fmt::format("an image of format {} for features {:#x}", name, missing);
    if (is_depth(info.format) && info.imageType != VK_IMAGE_TYPE_2D) return "a depth image that is not 2D";
    const std::uint32_t side = std::max({info.extent.width, info.extent.height, info.extent.depth});
    if (side > max_side(limits, info)) return fmt::format("an image of {} texels a side", side);
    if (info.arrayLayers > limits.maxImageArrayLayers) return fmt::format("an image of {} layers", info.arrayLayers);
    if (info.mipLevels > static_cast<std::uint32_t>(std::bit_width(side)))
        return fmt::format("an image of {} mip levels", info.mipLevels);
    if ((sample_counts(limits, info) & info.samples) == 0)
        return fmt::format("an image of {} samples", static_cast<int>(info.samples));
    return {};
}

VkResult create_image(VkDevice device, const VkImageCreateInfo* info, const VkAllocationCallbacks* allocator,
                      VkImage* image) {
    SmallestState& state = smallest();
    if (const std::string text = beyond(*info); !text.empty()) {
        refuse(text);
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    const VkResult result = state.real.CreateImage(device, info, allocator, image);
    const std::lock_guard lock(state.mutex);
    if (result == VK_SUCCESS) state.images[*image] = info->format;
    return result;
}

VkResult create_view(VkDevice device, const VkImageViewCreateInfo* info, const VkAllocationCallbacks* allocator,
                     VkImageView* view) {
    SmallestState& state = smallest();
    std::string text;
    if (info->viewType == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) text = "a view of an array of cubes";
    if (smallest_image_features(info->format) == 0)
        text = fmt::format("a view of format {}", format_name(info->format));
    if (!text.empty()) {
        refuse(text);
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    const VkResult result = state.real.CreateImageView(device, info, allocator, view);
    const std::lock_guard lock(state.mutex);
    if (result == VK_SUCCESS) state.views[*view] = info->format;
    return result;
}

VkResult create_sampler(VkDevice device, const VkSamplerCreateInfo* info, const VkAllocationCallbacks* allocator,
                        VkSampler* sampler) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    std::string text;
    if (info->anisotropyEnable == VK_TRUE) text = "a sampler with anisotropy";
    if (info->mipLodBias > state.limits.maxSamplerLodBias)
        text = fmt::format("a sampler with a bias of {}", info->mipLodBias);
    for (const VkSamplerAddressMode mode : {info->addressModeU, info->addressModeV, info->addressModeW}) {
        if (mode == VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) text = "a sampler that mirrors once";
    }
    if (state.samplers.size() >= state.limits.maxSamplerAllocationCount)
        text = fmt::format("more than {} samplers", state.limits.maxSamplerAllocationCount);
    if (!text.empty()) {
        refuse(text);
        return VK_ERROR_TOO_MANY_OBJECTS;
    }
    const VkResult result = state.real.CreateSampler(device, info, allocator, sampler);
    const bool is_linear = info->magFilter == VK_FILTER_LINEAR || info->minFilter == VK_FILTER_LINEAR ||
                           info->mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR;
    if (result == VK_SUCCESS) state.samplers[*sampler] = is_linear;
    if (result == VK_SUCCESS) state.comparing.erase(*sampler);
    if (result == VK_SUCCESS && info->compareEnable == VK_TRUE) state.comparing.insert(*sampler);
    return result;
}

}  // namespace

void replace_resources(Replacements& functions) {
    functions["vkAllocateMemory"] = as_void(allocate_memory);
    functions["vkFreeMemory"] = as_void(forget<&SmallestState::memories, &Dispatch::FreeMemory, VkDeviceMemory>);
    functions["vkMapMemory"] = as_void(map_memory);
    functions["vkGetImageMemoryRequirements2"] = as_void(get_image_requirements);
    functions["vkGetBufferMemoryRequirements2"] = as_void(get_buffer_requirements);
    functions["vkBindImageMemory"] = as_void(bind_image);
    functions["vkBindBufferMemory"] = as_void(bind_buffer);
    functions["vkCreateBuffer"] = as_void(create_buffer);
    functions["vkCreateImage"] = as_void(create_image);
    functions["vkDestroyImage"] = as_void(forget<&SmallestState::images, &Dispatch::DestroyImage, VkImage>);
    functions["vkCreateImageView"] = as_void(create_view);
    functions["vkDestroyImageView"] = as_void(forget<&SmallestState::views, &Dispatch::DestroyImageView, VkImageView>);
    functions["vkCreateSampler"] = as_void(create_sampler);
    functions["vkDestroySampler"] = as_void(forget<&SmallestState::samplers, &Dispatch::DestroySampler, VkSampler>);
}

}  // namespace darkroom::gpu::test
