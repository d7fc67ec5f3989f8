// SPDX-License-Identifier: MIT
#pragma once
// For tests only: what the smallest device that Vulkan 1.3 allows says of itself. From the specification, "Required
// Limits" (the column without the optional feature), "Feature Requirements" and "Required Format Support".

#include <vulkan/vulkan.h>

#include <cstdint>

namespace darkroom::gpu::test {

/// What VkPhysicalDeviceLimits has no member for.
inline constexpr VkDeviceSize smallest_max_buffer = VkDeviceSize{1} << 30U;
inline constexpr VkDeviceSize smallest_max_allocation = VkDeviceSize{1} << 30U;
inline constexpr std::uint32_t smallest_set_descriptors = 1024;

/// Sets what has a minimum or a maximum, and leaves the rest.
void limit(VkPhysicalDeviceLimits& limits);
/// Of the structures of a pNext chain, those that have limits of later versions.
void limit_chain(void* chain);
/// Leaves on what Vulkan 1.3 demands, in the structures of 1.0 to 1.3 and of the two extensions that the library
/// knows.
void limit_features(VkPhysicalDeviceFeatures2& features);

/// For images with optimal tiling; linear tiling has none.
[[nodiscard]] VkFormatFeatureFlags smallest_image_features(VkFormat format);
[[nodiscard]] VkFormatFeatureFlags smallest_buffer_features(VkFormat format);

/// Two types on one heap: what the GPU reaches fast, and what the CPU reaches. Images are bound to the first only.
inline constexpr std::uint32_t smallest_device_type = 0, smallest_host_type = 1;
void limit_memory(VkPhysicalDeviceMemoryProperties& memory);

/// Whether SPIR-V may declare it with no optional feature.
[[nodiscard]] bool is_smallest_capability(std::uint32_t capability);

}  // namespace darkroom::gpu::test
