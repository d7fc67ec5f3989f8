// SPDX-License-Identifier: MIT
// What the smallest device says of itself when it is asked, and how it is created.
#include <fmt/format.h>

#include <algorithm>

#include "gpu/test_smallest/facts.hpp"
#include "gpu/test_smallest/state.hpp"

namespace darkroom::gpu::test {

namespace {

void get_properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
    smallest().real.GetPhysicalDeviceProperties(device, properties);
    properties->apiVersion = VK_API_VERSION_1_3;
    limit(properties->limits);
}

void get_properties_2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    smallest().real.GetPhysicalDeviceProperties2(device, properties);
    properties->properties.apiVersion = VK_API_VERSION_1_3;
    limit(properties->properties.limits);
    limit_chain(properties->pNext);
}

void get_features_2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
    smallest().real.GetPhysicalDeviceFeatures2(device, features);
    limit_features(*features);
}

void get_format_properties(VkPhysicalDevice, VkFormat format, VkFormatProperties* properties) {
    *properties = {.optimalTilingFeatures = smallest_image_features(format),
                   .bufferFeatures = smallest_buffer_features(format)};
}

void get_memory_properties(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* memory) {
    SmallestState& state = smallest();
    state.real.GetPhysicalDeviceMemoryProperties(device, memory);
    const VkPhysicalDeviceMemoryProperties real = *memory;
    limit_memory(*memory);
    for (std::uint32_t type = 0; type < memory->memoryTypeCount; ++type) {
        const VkMemoryPropertyFlags wanted = memory->memoryTypes[type].propertyFlags;
        const auto has_them = [&](const VkMemoryType& there) { return (there.propertyFlags & wanted) == wanted; };
        const std::span types(real.memoryTypes, real.memoryTypeCount);
        state.real_types[type] = static_cast<std::uint32_t>(std::ranges::find_if(types, has_them) - types.begin());
    }
}

void get_queue_families(VkPhysicalDevice device, std::uint32_t* count, VkQueueFamilyProperties* families) {
    smallest().real.GetPhysicalDeviceQueueFamilyProperties(device, count, families);
    for (std::uint32_t family = 0; families != nullptr && family < *count; ++family) {
        families[family].timestampValidBits = 0;
        if (!smallest().has_graphics) families[family].queueFlags &= ~VkQueueFlags{VK_QUEUE_GRAPHICS_BIT};
    }
}

VkResult enumerate_extensions(VkPhysicalDevice, const char*, std::uint32_t* count, VkExtensionProperties*) {
    *count = 0;
    return VK_SUCCESS;
}

/// Whether `asked` has a feature that `there` has not, of structures that are all VkBool32 behind their head.
template <class Features>
bool is_beyond(const Features& asked, const Features& there, std::size_t head) {
    const auto* const a = reinterpret_cast<const VkBool32*>(reinterpret_cast<const std::byte*>(&asked) + head);
    const auto* const b = reinterpret_cast<const VkBool32*>(reinterpret_cast<const std::byte*>(&there) + head);
    const std::size_t count = (sizeof(Features) - head) / sizeof(VkBool32);
    for (std::size_t index = 0; index < count; ++index) {
        if (a[index] == VK_TRUE && b[index] != VK_TRUE) return true;
    }
    return false;
}

template <class Features>
bool is_beyond(VkPhysicalDevice device, const void* structure, std::size_t head) {
    const auto& asked = *static_cast<const Features*>(structure);
    Features there{.sType = asked.sType};
    VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &there};
    get_features_2(device, &all);
    return is_beyond(asked, there, head);
}

bool asks_too_much(VkPhysicalDevice device, const VkDeviceCreateInfo& info) {
    VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    get_features_2(device, &all);
    if (info.pEnabledFeatures != nullptr && is_beyond(*info.pEnabledFeatures, all.features, 0)) return true;
    const auto* link = static_cast<const VkBaseInStructure*>(info.pNext);
    for (; link != nullptr; link = link->pNext) {
        constexpr std::size_t head = offsetof(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge);
        const void* const structure = link;
        bool is_too_much = false;
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2) {
            is_too_much =
                is_beyond(static_cast<const VkPhysicalDeviceFeatures2*>(structure)->features, all.features, 0);
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES) {
            is_too_much = is_beyond<VkPhysicalDeviceVulkan11Features>(device, structure, head);
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            is_too_much = is_beyond<VkPhysicalDeviceVulkan12Features>(device, structure, head);
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            is_too_much = is_beyond<VkPhysicalDeviceVulkan13Features>(device, structure, head);
        }
        if (is_too_much) return true;
    }
    return false;
}

VkResult create_device(VkPhysicalDevice device, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
                       VkDevice* out) {
    if (info->enabledExtensionCount > 0) {
        refuse(fmt::format("the device extension {}", info->ppEnabledExtensionNames[0]));
        return VK_ERROR_EXTENSION_NOT_PRESENT;
    }
    if (asks_too_much(device, *info)) {
        refuse("a device feature that is optional");
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    return smallest().real.CreateDevice(device, info, allocator, out);
}

VkResult create_query_pool(VkDevice device, const VkQueryPoolCreateInfo* info, const VkAllocationCallbacks* allocator,
                           VkQueryPool* pool) {
    if (info->queryType == VK_QUERY_TYPE_PIPELINE_STATISTICS) {
        refuse("a query of pipeline statistics");
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    return smallest().real.CreateQueryPool(device, info, allocator, pool);
}

}  // namespace

void replace_queries(Replacements& functions) {
    functions["vkGetPhysicalDeviceProperties"] = as_void(get_properties);
    functions["vkGetPhysicalDeviceProperties2"] = as_void(get_properties_2);
    functions["vkGetPhysicalDeviceFeatures2"] = as_void(get_features_2);
    functions["vkGetPhysicalDeviceFormatProperties"] = as_void(get_format_properties);
    functions["vkGetPhysicalDeviceMemoryProperties"] = as_void(get_memory_properties);
    functions["vkGetPhysicalDeviceQueueFamilyProperties"] = as_void(get_queue_families);
    functions["vkEnumerateDeviceExtensionProperties"] = as_void(enumerate_extensions);
    functions["vkCreateDevice"] = as_void(create_device);
    functions["vkCreateQueryPool"] = as_void(create_query_pool);
}

}  // namespace darkroom::gpu::test
