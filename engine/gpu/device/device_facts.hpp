// SPDX-License-Identifier: MIT
#pragma once
// What a physical device is and what it lacks, for devices that the library makes and for those that it adopts.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/device/context.hpp"

namespace darkroom::gpu {

/// "1.3"
[[nodiscard]] std::string version_text(std::uint32_t version);

/// The names that a device of this version, made for an application of this version, has the promoted functions by.
[[nodiscard]] PromotedNames promoted_names(std::uint32_t api_version);

[[nodiscard]] VkResult device_extensions(const Dispatch& vk, VkPhysicalDevice device,
                                         std::vector<VkExtensionProperties>& out);
[[nodiscard]] bool has_extension(std::span<const VkExtensionProperties> extensions, std::string_view name);

/// Name, driver and version. Needs an instance of Vulkan 1.1.
[[nodiscard]] DeviceInfo identify(const Dispatch& vk, VkPhysicalDevice device, std::uint32_t index);

[[nodiscard]] std::vector<VkQueueFamilyProperties> queue_families(const Dispatch& vk, VkPhysicalDevice device);
/// The first one with graphics and compute.
[[nodiscard]] std::optional<std::uint32_t> find_queue_family(const Dispatch& vk, VkPhysicalDevice device);

/// What a device that the library is to make would be without, each as a phrase; VkResult as one, too.
[[nodiscard]] std::vector<std::string> missing_for_creation(const Dispatch& vk, VkPhysicalDevice device,
                                                            const DeviceInfo& info);
/// Why the library can make no device of it (DeviceInfo::reason). Empty: it can.
[[nodiscard]] std::string why_unusable(const Dispatch& vk, VkPhysicalDevice device, const DeviceInfo& info,
                                       bool compiles_only);

/// The extensions that a device of these is created with by all means: promoted ones by their own names where it is of
/// an older version, and VK_KHR_portability_subset where it is there, as its specification demands. None of the
/// features that it makes optional is used.
[[nodiscard]] std::vector<const char*> needed_extensions(std::span<const VkExtensionProperties> there,
                                                         PromotedNames names);

/// The folder of the caches: the user's own where none is wanted, none where they are switched off.
[[nodiscard]] std::filesystem::path cache_folder_of(const std::filesystem::path& wanted, bool caches_on_disk);
/// Makes it and what it lies in, as far as they are not there: others may write to none of those.
void make_cache_folder(const std::filesystem::path& folder);
void keep_others_from_writing(const std::filesystem::path& path);

}  // namespace darkroom::gpu
