// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/device.hpp>
#include <string_view>

#include "core/caught.hpp"
#include "gpu/device/context.hpp"
#include "gpu/device/device_facts.hpp"

namespace darkroom {

namespace {

using gpu::Context;
using gpu::PromotedNames;

struct EnabledFeatures {
    VkPhysicalDeviceFeatures core{};
    bool has_synchronization2 = false;
    bool has_dynamic_rendering = false;
    bool has_robust_images = false;
    bool has_host_query_reset = false;
};

EnabledFeatures read_chain(const VkPhysicalDeviceFeatures2* features) {
    EnabledFeatures enabled;
    if (features == nullptr) return enabled;
    enabled.core = features->features;
    const auto* link = static_cast<const VkBaseInStructure*>(features->pNext);
    for (; link != nullptr; link = link->pNext) {
        const void* const structure = link;
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            const auto& features13 = *static_cast<const VkPhysicalDeviceVulkan13Features*>(structure);
            enabled.has_synchronization2 |= features13.synchronization2 == VK_TRUE;
            enabled.has_dynamic_rendering |= features13.dynamicRendering == VK_TRUE;
            enabled.has_robust_images |= features13.robustImageAccess == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            const auto& features12 = *static_cast<const VkPhysicalDeviceVulkan12Features*>(structure);
            enabled.has_host_query_reset |= features12.hostQueryReset == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceHostQueryResetFeatures*>(structure);
            enabled.has_host_query_reset |= single.hostQueryReset == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceSynchronization2Features*>(structure);
            enabled.has_synchronization2 |= single.synchronization2 == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceDynamicRenderingFeatures*>(structure);
            enabled.has_dynamic_rendering |= single.dynamicRendering == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceImageRobustnessFeatures*>(structure);
            enabled.has_robust_images |= single.robustImageAccess == VK_TRUE;
        }
    }
    return enabled;
}

bool has_name(std::span<const char* const> names, std::string_view wanted) {
    return std::ranges::any_of(names, [&](const char* name) { return wanted == name; });
}

Result<> check_desc(const AdoptDesc& desc) {
    std::vector<std::string> missing;
    if (desc.instance == VK_NULL_HANDLE) missing.emplace_back("instance");
    if (desc.physical_device == VK_NULL_HANDLE) missing.emplace_back("physical_device");
    if (desc.device == VK_NULL_HANDLE) missing.emplace_back("device");
    if (desc.get_proc == nullptr) missing.emplace_back("get_proc");
    if (!missing.empty()) {
        return user_error(fmt::format("adopting a device: not given: {}", fmt::join(missing, ", ")));
    }
    if ((desc.memory.allocate == nullptr) != (desc.memory.free == nullptr)) {
        return user_error(fmt::format("adopting a device: memory.{} is given without memory.{}",
                                      desc.memory.allocate != nullptr ? "allocate" : "free",
                                      desc.memory.allocate != nullptr ? "free" : "allocate"));
    }
    if (desc.api_version < VK_API_VERSION_1_2) {
        return user_error(
            fmt::format("adopting a device: api_version is {}; the instance must be made for 1.2 or later",
                        gpu::version_text(desc.api_version)));
    }
    return {};
}

/// Vulkan takes the lower of what the device has and what the instance was made for.
std::uint32_t usable_version(const AdoptDesc& desc, const DeviceInfo& info) {
    return std::min(desc.api_version, info.api_version);
}

std::vector<std::string> missing_extensions(const AdoptDesc& desc, const DeviceInfo& info) {
    const bool is_old_device = info.api_version < VK_API_VERSION_1_3;
    const std::string why = is_old_device ? fmt::format("the device has {}", gpu::version_text(info.api_version))
                                          : fmt::format("api_version is {}", gpu::version_text(desc.api_version));
    std::vector<std::string> missing;
    if (usable_version(desc, info) >= VK_API_VERSION_1_3) return missing;
    if (usable_version(desc, info) < VK_API_VERSION_1_2) return {fmt::format("Vulkan 1.2 or 1.3 ({})", why)};
    for (const char* const name : gpu::promoted_extensions) {
        if (has_name(desc.enabled_device_extensions, name)) continue;
        missing.push_back(fmt::format("Vulkan 1.3 ({}) or {} in enabled_device_extensions", why, name));
    }
    return missing;
}

std::vector<std::string> missing_capabilities(const Context& context, const AdoptDesc& desc,
                                              const EnabledFeatures& enabled) {
    std::vector<std::string> missing = missing_extensions(desc, context.info);
    const std::vector<VkQueueFamilyProperties> families = gpu::queue_families(context.vk, desc.physical_device);
    if (desc.queue_family >= families.size()) {
        missing.push_back(
            fmt::format("queue family {} (the device has 0 to {})", desc.queue_family, families.size() - 1));
    } else if ((families[desc.queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
        missing.push_back(fmt::format("compute in queue family {}", desc.queue_family));
    }
    const std::vector<std::string> of_device =
        gpu::missing_for_creation(context.vk, desc.physical_device, context.info);
    const char* const where = desc.enabled_features == nullptr ? "enabled_features is null" : "not in enabled_features";
    const auto check = [&](bool is_enabled, std::string_view name) {
        const std::string feature = fmt::format("the feature {}", name);
        if (is_enabled) return;
        const bool is_there = std::ranges::find(of_device, feature) == of_device.end();
        missing.push_back(is_there ? fmt::format("{} (it has it, but it is not enabled: {})", feature, where)
                                   : feature);
    };
    check(enabled.has_synchronization2, "synchronization2");
    check(enabled.has_dynamic_rendering, "dynamicRendering");
    return missing;
}

/// Functions that are not there are as often the fault of an instance that was made for an older Vulkan.
Failure lacking(const AdoptDesc& desc, const Result<>& loaded) {
    return machine_error(
        fmt::format("adopting a device: {}, or the instance was made for an older Vulkan than api_version says ({})",
                    loaded.error().text, gpu::version_text(desc.api_version)),
        ErrorCode::Unsupported);
}

}  // namespace

Result<Device> Device::adopt(const AdoptDesc& desc) try {
    DARKROOM_TRY(check_desc(desc));
    auto context = std::make_shared<Context>();
    context->log = desc.log;
    context->cache_folder = gpu::cache_folder_of(desc.cache_folder, desc.caches_on_disk);
    context->vk.GetInstanceProcAddr = desc.get_proc;
    context->instance = desc.instance;
    context->physical_device = desc.physical_device;
    context->queue_family = desc.queue_family;
    context->allocator = desc.allocator;
    context->memory_hooks = desc.memory;
    context->pipeline_cache = desc.pipeline_cache;
    const bool has_debug_utils = has_name(desc.enabled_instance_extensions, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (const Result<> loaded = context->vk.load_instance(desc.instance, has_debug_utils); !loaded)
        return lacking(desc, loaded);
    context->info = gpu::identify(context->vk, desc.physical_device, 0);
    const EnabledFeatures enabled = read_chain(desc.enabled_features);
    if (const std::vector<std::string> missing = missing_capabilities(*context, desc, enabled); !missing.empty()) {
        return failure({Fault::User,
                        fmt::format("adopting \"{}\": it lacks {}", context->info.name, fmt::join(missing, ", ")),
                        ErrorCode::Unsupported});
    }
    context->info.is_usable = true;
    context->traits.has_extended_storage_formats = enabled.core.shaderStorageImageExtendedFormats == VK_TRUE;
    context->traits.has_storage_write_without_format = enabled.core.shaderStorageImageWriteWithoutFormat == VK_TRUE;
    context->traits.has_robust_images = enabled.has_robust_images;
    context->traits.has_host_query_reset = enabled.has_host_query_reset;
    context->traits.has_wireframe = enabled.core.fillModeNonSolid == VK_TRUE;
    context->traits.has_depth_clamp = enabled.core.depthClamp == VK_TRUE;
    context->traits.has_debug_labels = has_debug_utils;
    const PromotedNames names = gpu::promoted_names(usable_version(desc, context->info));
    if (const Result<> loaded = context->vk.load_device(desc.device, has_debug_utils, names); !loaded)
        return lacking(desc, loaded);
    context->device = desc.device;
    DARKROOM_TRY(context->finish(desc.kernels));
    return Device(std::move(context));
} catch (...) {
    return caught("adopting a device");
}

namespace {

/// docs/embedding.md quotes how it is used.
[[maybe_unused]] void usage_device(const AdoptDesc& host, const VkPhysicalDeviceFeatures2& features,
                                   void (*report)(const Error&)) {
    const auto device = darkroom::Device::adopt({.instance = host.instance,
                                                 .physical_device = host.physical_device,
                                                 .device = host.device,
                                                 .queue_family = host.queue_family,
                                                 .enabled_features = &features,
                                                 .get_proc = host.get_proc,
                                                 .kernels = host.kernels});
    if (!device) return report(device.error());
}

}  // namespace

}  // namespace darkroom
