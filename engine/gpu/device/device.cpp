// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <darkroom/device.hpp>
#include <iterator>
#include <string_view>

#include "core/caught.hpp"
#include "gpu/device/assumed_device.hpp"
#include "gpu/device/cleared.hpp"
#include "gpu/device/context.hpp"
#include "gpu/device/device_facts.hpp"
#include "gpu/device/enumerate.hpp"
#include "gpu/device/loader.hpp"
#include "gpu/device/select_device.hpp"

namespace darkroom {

namespace {

using namespace std::string_view_literals;
using gpu::Context;
using gpu::Dispatch;

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

bool wants_validation(const DeviceDesc& desc) {
    const char* variable = std::getenv("DARKROOM_VALIDATE");
    return desc.validate || (variable != nullptr && std::string_view(variable) == "1");
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user_data) {
    // Layers since 2024 warn of outputs of a shader that a pass has no image for, which Vulkan allows.
    constexpr std::array allowed{"Undefined-Value-ShaderOutputNotConsumed"sv, "WARNING-Shader-OutputNotConsumed"sv};
    const std::string_view id = data->pMessageIdName == nullptr ? "" : data->pMessageIdName;
    if (std::ranges::any_of(allowed, [&](std::string_view begin) { return id.starts_with(begin); })) return VK_FALSE;
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

/// Errors: the layer is not there, VkResult.
Result<> check_layer(const Context& context, std::string_view name) {
    std::vector<VkLayerProperties> layers;
    const VkResult listed = gpu::enumerate(layers, context.vk.EnumerateInstanceLayerProperties);
    DARKROOM_TRY(context.check(listed, "listing Vulkan's layers"));
    if (std::ranges::any_of(layers, [&](const VkLayerProperties& layer) { return name == layer.layerName; })) return {};
    return machine_error(
        fmt::format("validation was asked for, but the layer {} is not installed (package vulkan-validationlayers)",
                    name),
        ErrorCode::Unsupported);
}

Result<std::vector<VkExtensionProperties>> instance_extensions(const Context& context, const char* layer) {
    std::vector<VkExtensionProperties> out;
    const VkResult listed = gpu::enumerate(out, [&](std::uint32_t* count, VkExtensionProperties* to) {
        return context.vk.EnumerateInstanceExtensionProperties(layer, count, to);
    });
    DARKROOM_TRY(context.check(listed, "listing the extensions of Vulkan's instances"));
    return out;
}

/// Refuses what is not there.
Result<> check_extensions(std::span<const char* const> wanted, const auto& has, std::string_view who) {
    std::vector<std::string_view> missing;
    for (const char* const name : wanted)
        if (!has(name)) missing.emplace_back(name);
    if (missing.empty()) return {};
    return machine_error(fmt::format("{} lacks {}", who, fmt::join(missing, ", ")), ErrorCode::Unsupported);
}

Result<> create_instance(Context& context, PFN_vkGetInstanceProcAddr loader, bool validate,
                         std::span<const char* const> wanted = {}) {
    Dispatch& vk = context.vk;
    DARKROOM_TRY(vk.load_loader(loader));
    std::uint32_t loader_version = 0;
    DARKROOM_TRY(context.check(vk.EnumerateInstanceVersion(&loader_version), "asking the Vulkan loader's version"));
    if (loader_version < VK_API_VERSION_1_2) {
        return machine_error(fmt::format("the Vulkan loader is of version {}; 1.2 or later is needed",
                                         gpu::version_text(loader_version)),
                             ErrorCode::Unsupported);
    }
    if (validate) DARKROOM_TRY(check_layer(context, validation_layer));
    DARKROOM_TRY_VALUE(const auto own, instance_extensions(context, nullptr));
    const auto has = [&](std::string_view name) { return gpu::has_extension(own, name); };
    context.traits.has_debug_labels = has(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    // The layer brings the extension with it where the loader has none of its own.
    if (validate && !context.traits.has_debug_labels) {
        DARKROOM_TRY_VALUE(const auto brought, instance_extensions(context, validation_layer));
        context.traits.has_debug_labels = gpu::has_extension(brought, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    DARKROOM_TRY(check_extensions(wanted, has, "the Vulkan loader"));
    std::vector<const char*> extensions(wanted.begin(), wanted.end());
    if (context.traits.has_debug_labels) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validate) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    // Else a loader leaves out what lacks a part of Vulkan, as MoltenVK on macOS does.
    const bool has_portability = has(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (has_portability) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);

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
        .flags = has_portability ? VkInstanceCreateFlags{VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR} : 0,
        .pApplicationInfo = &application,
        .enabledLayerCount = validate ? 1U : 0U,
        .ppEnabledLayerNames = &validation_layer,
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    const VkResult created = vk.CreateInstance(&create_info, context.allocator, &context.instance);
    // So say loaders that find none.
    if (created == VK_ERROR_INCOMPATIBLE_DRIVER) return gpu::no_device(fmt::format(" ({})", gpu::result_name(created)));
    DARKROOM_TRY(context.check(created, "creating a Vulkan instance"));
    context.is_owner = true;
    DARKROOM_TRY(vk.load_instance(context.instance, context.traits.has_debug_labels));
    if (!validate) return {};
    return context.check(gpu::cleared_on_failure(vk.CreateDebugUtilsMessengerEXT(context.instance, &messenger,
                                                                                 context.allocator, &context.messenger),
                                                 context.messenger),
                         "listening to the validation layer");
}

struct Candidate {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    DeviceInfo info;
    std::ptrdiff_t rank = 0;  ///< lower is better
};

std::ptrdiff_t rank_of(const Context& context, VkPhysicalDevice device, const DeviceInfo& info) {
    VkPhysicalDeviceProperties properties{};
    context.vk.GetPhysicalDeviceProperties(device, &properties);
    const std::array order{VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
                           VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, VK_PHYSICAL_DEVICE_TYPE_OTHER,
                           VK_PHYSICAL_DEVICE_TYPE_CPU};
    const std::ptrdiff_t rank = std::ranges::find(order, properties.deviceType) - order.begin();
    return info.is_usable ? rank : rank + std::ssize(order) + 1;
}

/// Best first.
Result<std::vector<Candidate>> find_devices(const Context& context, bool compiles_only = false) {
    std::vector<VkPhysicalDevice> handles;
    const VkResult result = gpu::enumerate(handles, [&](std::uint32_t* count, VkPhysicalDevice* to) {
        return context.vk.EnumeratePhysicalDevices(context.instance, count, to);
    });
    DARKROOM_TRY(context.check(result, "listing the Vulkan devices"));
    std::vector<Candidate> candidates;
    for (std::uint32_t index = 0; index < handles.size(); ++index) {
        Candidate candidate{.device = handles[index], .info = gpu::identify(context.vk, handles[index], index)};
        candidate.info.reason = gpu::why_unusable(context.vk, candidate.device, candidate.info, compiles_only);
        candidate.info.is_usable = candidate.info.reason.empty();
        candidate.rank = rank_of(context, candidate.device, candidate.info);
        candidates.push_back(std::move(candidate));
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::rank);
    return candidates;
}

std::vector<DeviceInfo> infos_of(std::span<const Candidate> candidates) {
    std::vector<DeviceInfo> infos;
    for (const Candidate& candidate : candidates) infos.push_back(candidate.info);
    return infos;
}

Result<Candidate> choose(std::span<const Candidate> candidates, const std::string& select) {
    DARKROOM_TRY_VALUE(const std::size_t place, gpu::select_device(infos_of(candidates), select));
    const Candidate& chosen = candidates[place];
    if (!chosen.info.is_usable) {
        return machine_error(
            fmt::format("device {} \"{}\": {}", chosen.info.index, chosen.info.name, chosen.info.reason),
            ErrorCode::Unsupported);
    }
    return chosen;
}

Result<> create_device(Context& context, std::span<const char* const> wanted) {
    const Dispatch& vk = context.vk;
    std::vector<VkExtensionProperties> there;
    DARKROOM_TRY(context.check(gpu::device_extensions(vk, context.physical_device, there),
                               fmt::format("listing the extensions of \"{}\"", context.info.name)));
    const auto has = [&](std::string_view name) { return gpu::has_extension(there, name); };
    DARKROOM_TRY(check_extensions(wanted, has, fmt::format("device \"{}\"", context.info.name)));
    VkPhysicalDeviceFeatures2 queried{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    vk.GetPhysicalDeviceFeatures2(context.physical_device, &queried);
    const VkPhysicalDeviceFeatures& available = queried.features;
    context.traits.has_extended_storage_formats = available.shaderStorageImageExtendedFormats == VK_TRUE;
    context.traits.has_storage_write_without_format = available.shaderStorageImageWriteWithoutFormat == VK_TRUE;
    context.traits.has_wireframe = available.fillModeNonSolid == VK_TRUE;
    context.traits.has_depth_clamp = available.depthClamp == VK_TRUE;
    // Every device has both. Semaphores are for who submits on a device of ours; the library itself needs none.
    context.traits.has_host_query_reset = true;
    VkPhysicalDeviceVulkan12Features features12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .hostQueryReset = VK_TRUE,
        .timelineSemaphore = VK_TRUE,
    };
    VkPhysicalDeviceSynchronization2Features synchronization{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
        .pNext = &features12,
        .synchronization2 = VK_TRUE,
    };
    VkPhysicalDeviceDynamicRenderingFeatures rendering{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        .pNext = &synchronization,
        .dynamicRendering = VK_TRUE,
    };
    void* first = &rendering;
    // Every device of 1.3 has it.
    const gpu::PromotedNames names = gpu::promoted_names(context.info.api_version);
    context.traits.has_robust_images = names == gpu::PromotedNames::Core;
    VkPhysicalDeviceImageRobustnessFeatures robustness{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES,
        .pNext = first,
        .robustImageAccess = VK_TRUE,
    };
    if (context.traits.has_robust_images) first = &robustness;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pNext = first,
        .pipelineExecutableInfo = VK_TRUE,
    };
    if (context.compiles_only) first = &statistics;
    const VkPhysicalDeviceFeatures2 features{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = first,
        // Users' effects write into buffers, and must not reach beyond them. Every device has it.
        .features = {.robustBufferAccess = VK_TRUE,
                     .fullDrawIndexUint32 = available.fullDrawIndexUint32,
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
    std::vector<const char*> extensions(wanted.begin(), wanted.end());
    std::ranges::copy(gpu::needed_extensions(there, names), std::back_inserter(extensions));
    if (context.compiles_only) extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
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
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    VkDevice device = VK_NULL_HANDLE;
    const VkResult created = vk.CreateDevice(context.physical_device, &create_info, context.allocator, &device);
    DARKROOM_TRY(context.check(created, fmt::format("creating a device on \"{}\"", context.info.name)));
    Result<> loaded = context.vk.load_device(device, context.traits.has_debug_labels, names);
    if (loaded && context.compiles_only) loaded = context.vk.load_statistics(device);
    if (!loaded) {
        if (vk.DestroyDevice != nullptr) vk.DestroyDevice(device, context.allocator);
        return loaded;
    }
    context.device = device;
    vk.GetDeviceQueue(device, context.queue_family, 0, &context.queue);
    return {};
}

}  // namespace

Device::Device(std::shared_ptr<gpu::Context> context) : context_(std::move(context)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceInfo& Device::info() const { return context_->info; }
std::uint64_t Device::validation_messages() const { return context_->validation_messages; }

Result<std::vector<DeviceInfo>> Device::list() try {
    DARKROOM_TRY_VALUE(const PFN_vkGetInstanceProcAddr loader, gpu::open_vulkan_loader());
    Context context;
    DARKROOM_TRY(create_instance(context, loader, false));
    DARKROOM_TRY_VALUE(const std::vector<Candidate> candidates, find_devices(context));
    return infos_of(candidates);
} catch (...) {
    return caught("listing devices");
}

Device Device::assumed(DeviceProfile profile) { return Device(gpu::assumed_context(profile)); }

Result<std::shared_ptr<Context>> gpu::create_context(PFN_vkGetInstanceProcAddr loader, const DeviceDesc& desc) {
    auto context = std::make_shared<Context>();
    context->log = desc.log;
    context->compiles_only = desc.compiles_only;
    context->cache_folder = cache_folder_of(desc.cache_folder, desc.caches_on_disk);
    DARKROOM_TRY(create_instance(*context, loader, wants_validation(desc), desc.instance_extensions));
    DARKROOM_TRY_VALUE(const std::vector<Candidate> candidates, find_devices(*context, desc.compiles_only));
    DARKROOM_TRY_VALUE(Candidate chosen, choose(candidates, desc.select));
    context->physical_device = chosen.device;
    context->info = std::move(chosen.info);
    context->queue_family = find_queue_family(context->vk, context->physical_device).value_or(0);
    DARKROOM_TRY(create_device(*context, desc.device_extensions));
    DARKROOM_TRY(context->finish(desc.kernels));
    return context;
}

Result<Device> Device::create(const DeviceDesc& desc) try {
    DARKROOM_TRY_VALUE(const PFN_vkGetInstanceProcAddr loader, gpu::open_vulkan_loader());
    DARKROOM_TRY_VALUE(std::shared_ptr<Context> context, gpu::create_context(loader, desc));
    return Device(std::move(context));
} catch (...) {
    return caught("creating a device");
}

}  // namespace darkroom
