// SPDX-License-Identifier: MIT
#include "gpu/device/device_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/system/folders.hpp"
#include "gpu/device/enumerate.hpp"

namespace darkroom::gpu {

bool has_extension(std::span<const VkExtensionProperties> extensions, std::string_view name) {
    return std::ranges::any_of(extensions, [&](const VkExtensionProperties& e) { return name == e.extensionName; });
}

VkResult device_extensions(const Dispatch& vk, VkPhysicalDevice device, std::vector<VkExtensionProperties>& out) {
    return enumerate(out, [&](std::uint32_t* count, VkExtensionProperties* to) {
        return vk.EnumerateDeviceExtensionProperties(device, nullptr, count, to);
    });
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
}

PromotedNames promoted_names(std::uint32_t api_version) {
    return api_version < VK_API_VERSION_1_3 ? PromotedNames::Khr : PromotedNames::Core;
}

DeviceInfo identify(const Dispatch& vk, VkPhysicalDevice device, std::uint32_t index) {
    VkPhysicalDeviceProperties core{};
    vk.GetPhysicalDeviceProperties(device, &core);
    DeviceInfo info{
        .index = index,
        .name = core.deviceName,
        .api_version = core.apiVersion,
        .is_software = core.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
        // So says RADV, the only driver that has them: "Null hardware (RADV NAVI21)".
        .is_null = std::string_view(core.deviceName).starts_with("Null hardware"),
    };
    // Older devices do not know the structure.
    if (core.apiVersion < VK_API_VERSION_1_2) return info;
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vk.GetPhysicalDeviceProperties2(device, &properties);
    info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    return info;
}

std::vector<VkQueueFamilyProperties> queue_families(const Dispatch& vk, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

std::optional<std::uint32_t> find_queue_family(const Dispatch& vk, VkPhysicalDevice device) {
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    const std::vector<VkQueueFamilyProperties> families = queue_families(vk, device);
    for (std::uint32_t family = 0; family < families.size(); ++family) {
        if ((families[family].queueFlags & needed) == needed) return family;
    }
    return {};
}

/// As a phrase behind "lacks".
std::string unlisted(VkResult result) { return fmt::format("a list of its extensions: {}", result_name(result)); }

std::vector<std::string> missing_for_creation(const Dispatch& vk, VkPhysicalDevice device, const DeviceInfo& info) {
    if (info.api_version < VK_API_VERSION_1_2) {
        return {fmt::format("Vulkan 1.3, or 1.2 with {} and {} (it has {})", VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME,
                            VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, version_text(info.api_version))};
    }
    std::vector<std::string> missing;
    if (promoted_names(info.api_version) == PromotedNames::Khr) {
        std::vector<VkExtensionProperties> extensions;
        if (const VkResult result = device_extensions(vk, device, extensions); result != VK_SUCCESS)
            return {unlisted(result)};
        for (const char* const name : promoted_extensions) {
            if (has_extension(extensions, name)) continue;
            missing.push_back(fmt::format("{} (needed on Vulkan {})", name, version_text(info.api_version)));
        }
    }
    if (missing.empty()) {
        VkPhysicalDeviceSynchronization2Features synchronization{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
        VkPhysicalDeviceDynamicRenderingFeatures rendering{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, .pNext = &synchronization};
        VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &rendering};
        vk.GetPhysicalDeviceFeatures2(device, &features);
        if (synchronization.synchronization2 == VK_FALSE) missing.emplace_back("the feature synchronization2");
        if (rendering.dynamicRendering == VK_FALSE) missing.emplace_back("the feature dynamicRendering");
    }
    if (!find_queue_family(vk, device)) missing.emplace_back("a queue family with graphics and compute");
    return missing;
}

std::vector<const char*> needed_extensions(std::span<const VkExtensionProperties> there, PromotedNames names) {
    std::vector<const char*> needed;
    if (names == PromotedNames::Khr) needed.assign(promoted_extensions.begin(), promoted_extensions.end());
    // Its name is in a header of Vulkan's that few have.
    constexpr const char* portability_subset = "VK_KHR_portability_subset";
    if (has_extension(there, portability_subset)) needed.push_back(portability_subset);
    return needed;
}

std::string why_unusable(const Dispatch& vk, VkPhysicalDevice device, const DeviceInfo& info, bool compiles_only) {
    std::vector<std::string> missing = missing_for_creation(vk, device, info);
    constexpr const char* statistics = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    if (compiles_only) {
        std::vector<VkExtensionProperties> extensions;
        if (const VkResult result = device_extensions(vk, device, extensions); result != VK_SUCCESS)
            missing.push_back(unlisted(result));
        else if (!has_extension(extensions, statistics))
            missing.push_back(fmt::format("{}, by which drivers say what their compilers made", statistics));
    }
    if (!missing.empty()) return fmt::format("lacks {}", fmt::join(missing, ", "));
    if (!info.is_null || compiles_only) return {};
    return "it is a null device, which compiles for hardware that is not there and runs nothing";
}

std::filesystem::path cache_folder_of(const std::filesystem::path& wanted, bool caches_on_disk) {
    const char* const variable = std::getenv("DARKROOM_SHADER_CACHE");
    if (!caches_on_disk || (variable != nullptr && std::string_view(variable) == "off")) return {};
    return wanted.empty() ? user_cache_folder() : wanted;
}

void keep_others_from_writing(const std::filesystem::path& path) {
    using enum std::filesystem::perms;
    std::error_code error;
    std::filesystem::permissions(path, group_write | others_write, std::filesystem::perm_options::remove, error);
}

void make_cache_folder(const std::filesystem::path& folder) {
    std::error_code error;
    if (folder.empty() || std::filesystem::exists(folder, error)) return;
    make_cache_folder(folder.parent_path());
    if (std::filesystem::create_directory(folder, error)) keep_others_from_writing(folder);
}

}  // namespace darkroom::gpu
