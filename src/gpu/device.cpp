// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <darkroom/device.hpp>
#include <optional>
#include <string_view>

#include "core/folders.hpp"
#include "gpu/context.hpp"

namespace darkroom {

namespace {

using gpu::Context;
using gpu::Dispatch;

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr VkQueueFlags needed_queue = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool wants_validation(const DeviceDesc& desc) {
    const char* variable = std::getenv("DARKROOM_VALIDATE");
    return desc.validate || (variable != nullptr && std::string_view(variable) == "1");
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user_data) {
    Context& context = *static_cast<Context*>(user_data);
    ++context.validation_messages;
    const bool is_error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
    context.say(is_error ? Severity::Error : Severity::Warning, data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Context& context) {
    return {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = &context,
    };
}

bool has_layer(const Dispatch& vk, std::string_view name) {
    std::uint32_t count = 0;
    vk.EnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vk.EnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const VkLayerProperties& layer) { return name == layer.layerName; });
}

bool has_instance_extension(const Dispatch& vk, const char* layer, std::string_view name) {
    std::uint32_t count = 0;
    vk.EnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vk.EnumerateInstanceExtensionProperties(layer, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const VkExtensionProperties& e) { return name == e.extensionName; });
}

Result<> create_instance(Context& context, bool validate) {
    Dispatch& vk = context.vk;
    if (Result<> loaded = vk.load_loader(vkGetInstanceProcAddr); !loaded) return loaded;
    if (validate && !has_layer(vk, validation_layer)) {
        return machine_error(
            fmt::format("validation was asked for, but the layer {} is not installed (package vulkan-validationlayers)",
                        validation_layer));
    }
    // The layer brings the extension with it where the loader has none of its own.
    context.traits.has_debug_labels =
        has_instance_extension(vk, nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
        (validate && has_instance_extension(vk, validation_layer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
    std::vector<const char*> extensions;
    if (context.traits.has_debug_labels) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validate) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    constexpr VkValidationFeatureEnableEXT synchronization =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(context);
    const VkValidationFeaturesEXT validation{
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = &synchronization,
    };
    const VkApplicationInfo application{
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "darkroom",
        .pEngineName = "darkroom",
        .apiVersion = VK_API_VERSION_1_3,
    };
    const VkInstanceCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validate ? &validation : nullptr,
        .pApplicationInfo = &application,
        .enabledLayerCount = validate ? 1U : 0U,
        .ppEnabledLayerNames = &validation_layer,
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    const VkResult created = vk.CreateInstance(&create_info, nullptr, &context.instance);
    if (Result<> checked = context.check(created, "creating a Vulkan instance"); !checked) return checked;
    context.is_owner = true;
    if (Result<> loaded = vk.load_instance(context.instance, context.traits.has_debug_labels); !loaded) return loaded;
    if (!validate) return {};
    return context.check(vk.CreateDebugUtilsMessengerEXT(context.instance, &messenger, nullptr, &context.messenger),
                         "listening to the validation layer");
}

std::optional<std::uint32_t> find_queue_family(const Context& context, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    context.vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    context.vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t family = 0; family < count; ++family) {
        if ((families[family].queueFlags & needed_queue) == needed_queue) return family;
    }
    return {};
}

struct AvailableFeatures {
    VkPhysicalDeviceFeatures core{};
    bool has_synchronization2 = false;
    bool has_dynamic_rendering = false;
};

AvailableFeatures query_features(const Context& context, VkPhysicalDevice device) {
    VkPhysicalDeviceVulkan13Features features13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features13};
    context.vk.GetPhysicalDeviceFeatures2(device, &features);
    return {
        .core = features.features,
        .has_synchronization2 = features13.synchronization2 == VK_TRUE,
        .has_dynamic_rendering = features13.dynamicRendering == VK_TRUE,
    };
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
}

DeviceInfo describe(const Context& context, VkPhysicalDevice device, std::uint32_t index) {
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    context.vk.GetPhysicalDeviceProperties2(device, &properties);
    DeviceInfo info{
        .index = index,
        .name = properties.properties.deviceName,
        .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
        .api_version = properties.properties.apiVersion,
        .is_software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
    };
    std::vector<std::string> missing;
    if (info.api_version < VK_API_VERSION_1_3) {
        missing.push_back(fmt::format("Vulkan 1.3 (it has {})", version_text(info.api_version)));
    } else {
        const AvailableFeatures features = query_features(context, device);
        if (!features.has_synchronization2) missing.emplace_back("the feature synchronization2");
        if (!features.has_dynamic_rendering) missing.emplace_back("the feature dynamicRendering");
    }
    if (!find_queue_family(context, device)) missing.emplace_back("a queue family with graphics and compute");
    info.is_usable = missing.empty();
    if (!missing.empty()) info.reason = fmt::format("lacks {}", fmt::join(missing, ", "));
    return info;
}

struct Candidate {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    DeviceInfo info;
    int rank = 0;  ///< lower is better
};

int rank_of(const Context& context, VkPhysicalDevice device, const DeviceInfo& info) {
    VkPhysicalDeviceProperties properties{};
    context.vk.GetPhysicalDeviceProperties(device, &properties);
    const std::array order{VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
                           VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, VK_PHYSICAL_DEVICE_TYPE_OTHER,
                           VK_PHYSICAL_DEVICE_TYPE_CPU};
    const auto place = std::ranges::find(order, properties.deviceType);
    const int rank = static_cast<int>(place - order.begin());
    return info.is_usable ? rank : rank + static_cast<int>(order.size()) + 1;
}

/// Best first.
Result<std::vector<Candidate>> find_devices(const Context& context) {
    std::uint32_t count = 0;
    VkResult result = context.vk.EnumeratePhysicalDevices(context.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> handles(count);
    if (result == VK_SUCCESS) result = context.vk.EnumeratePhysicalDevices(context.instance, &count, handles.data());
    if (Result<> checked = context.check(result, "listing the Vulkan devices"); !checked)
        return failure(std::move(checked));
    std::vector<Candidate> candidates;
    for (std::uint32_t index = 0; index < count; ++index) {
        Candidate candidate{.device = handles[index], .info = describe(context, handles[index], index)};
        candidate.rank = rank_of(context, candidate.device, candidate.info);
        candidates.push_back(std::move(candidate));
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::rank);
    return candidates;
}

std::string names_of(std::span<const Candidate> candidates) {
    std::vector<std::string> names;
    for (const Candidate& candidate : candidates) {
        names.push_back(fmt::format("{} \"{}\"", candidate.info.index, candidate.info.name));
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

Result<Candidate> select_device(std::span<const Candidate> candidates, const std::string& select) {
    if (candidates.empty()) return machine_error("no Vulkan device: the loader found no driver");
    const Candidate* chosen = nullptr;
    std::uint32_t index = 0;
    const char* const end = select.data() + select.size();
    const bool is_index = !select.empty() && std::from_chars(select.data(), end, index).ptr == end;
    for (const Candidate& candidate : candidates) {
        const bool is_match = is_index ? candidate.info.index == index
                                       : lower_case(candidate.info.name).find(lower_case(select)) != std::string::npos;
        if (!is_match) continue;
        chosen = &candidate;
        break;
    }
    if (chosen == nullptr) {
        return user_error(fmt::format("device \"{}\": no such device; there are {}", select, names_of(candidates)));
    }
    if (!chosen->info.is_usable) {
        return machine_error(
            fmt::format("device {} \"{}\": {}", chosen->info.index, chosen->info.name, chosen->info.reason));
    }
    return *chosen;
}

Result<> create_device(Context& context) {
    const Dispatch& vk = context.vk;
    const VkPhysicalDeviceFeatures available = query_features(context, context.physical_device).core;
    context.traits.has_extended_storage_formats = available.shaderStorageImageExtendedFormats == VK_TRUE;
    context.traits.has_storage_write_without_format = available.shaderStorageImageWriteWithoutFormat == VK_TRUE;
    context.traits.has_wireframe = available.fillModeNonSolid == VK_TRUE;
    context.traits.has_depth_clamp = available.depthClamp == VK_TRUE;
    // For who submits on a device of ours; the library itself needs none. Every 1.3 device has it.
    VkPhysicalDeviceVulkan12Features features12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .timelineSemaphore = VK_TRUE,
    };
    VkPhysicalDeviceVulkan13Features features13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .pNext = &features12,
        .synchronization2 = VK_TRUE,
        .dynamicRendering = VK_TRUE,
    };
    const VkPhysicalDeviceFeatures2 features{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = &features13,
        .features = {.fullDrawIndexUint32 = available.fullDrawIndexUint32,
                     .imageCubeArray = available.imageCubeArray,
                     .independentBlend = available.independentBlend,
                     .depthClamp = available.depthClamp,
                     .depthBiasClamp = available.depthBiasClamp,
                     .fillModeNonSolid = available.fillModeNonSolid,
                     .samplerAnisotropy = available.samplerAnisotropy,
                     .fragmentStoresAndAtomics = available.fragmentStoresAndAtomics,
                     .shaderStorageImageExtendedFormats = available.shaderStorageImageExtendedFormats,
                     .shaderStorageImageWriteWithoutFormat = available.shaderStorageImageWriteWithoutFormat},
    };
    constexpr float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue_info{
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = context.queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const VkDeviceCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue_info,
    };
    VkDevice device = VK_NULL_HANDLE;
    const VkResult created = vk.CreateDevice(context.physical_device, &create_info, nullptr, &device);
    if (Result<> checked = context.check(created, fmt::format("creating a device on \"{}\"", context.info.name));
        !checked) {
        return checked;
    }
    if (Result<> loaded = context.vk.load_device(device, context.traits.has_debug_labels); !loaded) {
        if (vk.DestroyDevice != nullptr) vk.DestroyDevice(device, nullptr);
        return loaded;
    }
    context.device = device;
    vk.GetDeviceQueue(device, context.queue_family, 0, &context.queue);
    return {};
}

std::filesystem::path cache_folder_of(const std::filesystem::path& wanted) {
    return wanted.empty() ? user_cache_folder() : wanted;
}

struct EnabledFeatures {
    VkPhysicalDeviceFeatures core{};
    bool has_synchronization2 = false;
    bool has_dynamic_rendering = false;
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
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceSynchronization2Features*>(structure);
            enabled.has_synchronization2 |= single.synchronization2 == VK_TRUE;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES) {
            const auto& single = *static_cast<const VkPhysicalDeviceDynamicRenderingFeatures*>(structure);
            enabled.has_dynamic_rendering |= single.dynamicRendering == VK_TRUE;
        }
    }
    return enabled;
}

std::vector<std::string> missing_handles(const AdoptDesc& desc) {
    std::vector<std::string> missing;
    if (desc.instance == VK_NULL_HANDLE) missing.emplace_back("instance");
    if (desc.physical_device == VK_NULL_HANDLE) missing.emplace_back("physical_device");
    if (desc.device == VK_NULL_HANDLE) missing.emplace_back("device");
    if (desc.get_proc == nullptr) missing.emplace_back("get_proc");
    return missing;
}

std::vector<std::string> missing_capabilities(const Context& context, const AdoptDesc& desc,
                                              const EnabledFeatures& enabled) {
    std::vector<std::string> missing;
    if (context.info.api_version < VK_API_VERSION_1_3) {
        missing.push_back(fmt::format("Vulkan 1.3 (the device has {})", version_text(context.info.api_version)));
    }
    std::uint32_t count = 0;
    context.vk.GetPhysicalDeviceQueueFamilyProperties(desc.physical_device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    context.vk.GetPhysicalDeviceQueueFamilyProperties(desc.physical_device, &count, families.data());
    if (desc.queue_family >= count) {
        missing.push_back(fmt::format("queue family {} (the device has 0 to {})", desc.queue_family, count - 1));
    } else {
        const VkQueueFlags flags = families[desc.queue_family].queueFlags;
        if ((flags & VK_QUEUE_GRAPHICS_BIT) == 0) {
            missing.push_back(fmt::format("graphics in queue family {}", desc.queue_family));
        }
        if ((flags & VK_QUEUE_COMPUTE_BIT) == 0) {
            missing.push_back(fmt::format("compute in queue family {}", desc.queue_family));
        }
    }
    const char* const where = desc.enabled_features == nullptr ? " (enabled_features is null)" : "";
    if (!enabled.has_synchronization2) missing.push_back(fmt::format("the feature synchronization2{}", where));
    if (!enabled.has_dynamic_rendering) missing.push_back(fmt::format("the feature dynamicRendering{}", where));
    return missing;
}

}  // namespace

Device::Device(std::shared_ptr<gpu::Context> context) : context_(std::move(context)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceInfo& Device::info() const { return context_->info; }
std::uint64_t Device::validation_messages() const { return context_->validation_messages; }

Result<std::vector<DeviceInfo>> Device::list() {
    Context context;
    if (Result<> created = create_instance(context, false); !created) return failure(std::move(created));
    Result<std::vector<Candidate>> candidates = find_devices(context);
    if (!candidates) return failure(std::move(candidates));
    std::vector<DeviceInfo> infos;
    for (Candidate& candidate : *candidates) infos.push_back(std::move(candidate.info));
    return infos;
}

Result<Device> Device::create(const DeviceDesc& desc) {
    auto context = std::make_shared<Context>();
    context->log = desc.log;
    context->cache_folder = cache_folder_of(desc.cache_folder);
    if (Result<> created = create_instance(*context, wants_validation(desc)); !created)
        return failure(std::move(created));
    const Result<std::vector<Candidate>> candidates = find_devices(*context);
    if (!candidates) return failure(candidates.error());
    Result<Candidate> chosen = select_device(*candidates, desc.select);
    if (!chosen) return failure(std::move(chosen));
    context->physical_device = chosen->device;
    context->info = std::move(chosen->info);
    context->queue_family = find_queue_family(*context, context->physical_device).value_or(0);
    if (Result<> created = create_device(*context); !created) return failure(std::move(created));
    if (Result<> finished = context->finish(); !finished) return failure(std::move(finished));
    return Device(std::move(context));
}

Result<Device> Device::adopt(const AdoptDesc& desc) {
    if (const std::vector<std::string> missing = missing_handles(desc); !missing.empty()) {
        return user_error(fmt::format("adopting a device: not given: {}", fmt::join(missing, ", ")));
    }
    auto context = std::make_shared<Context>();
    context->log = desc.log;
    context->cache_folder = cache_folder_of(desc.cache_folder);
    context->vk.GetInstanceProcAddr = desc.get_proc;
    context->instance = desc.instance;
    context->physical_device = desc.physical_device;
    context->queue_family = desc.queue_family;
    const bool has_debug_utils = std::ranges::any_of(desc.enabled_extensions, [](const char* name) {
        return std::strcmp(name, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
    });
    if (Result<> loaded = context->vk.load_instance(desc.instance, has_debug_utils); !loaded)
        return failure(std::move(loaded));
    context->info = describe(*context, desc.physical_device, 0);
    const EnabledFeatures enabled = read_chain(desc.enabled_features);
    if (const std::vector<std::string> missing = missing_capabilities(*context, desc, enabled); !missing.empty()) {
        return user_error(fmt::format("adopting \"{}\": it lacks {}", context->info.name, fmt::join(missing, ", ")));
    }
    context->traits.has_extended_storage_formats = enabled.core.shaderStorageImageExtendedFormats == VK_TRUE;
    context->traits.has_storage_write_without_format = enabled.core.shaderStorageImageWriteWithoutFormat == VK_TRUE;
    context->traits.has_wireframe = enabled.core.fillModeNonSolid == VK_TRUE;
    context->traits.has_depth_clamp = enabled.core.depthClamp == VK_TRUE;
    context->traits.has_debug_labels = has_debug_utils;
    if (Result<> loaded = context->vk.load_device(desc.device, has_debug_utils); !loaded)
        return failure(std::move(loaded));
    context->device = desc.device;
    if (Result<> finished = context->finish(); !finished) return failure(std::move(finished));
    return Device(std::move(context));
}

}  // namespace darkroom
