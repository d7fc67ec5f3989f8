// SPDX-License-Identifier: MIT
#include "gpu/context.hpp"

#include <fmt/format.h>

#include <cstring>
#include <system_error>
#include <vector>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "gpu/shader.hpp"

namespace darkroom::gpu {

std::string result_name(VkResult result) {
    switch (result) {
        case VK_SUCCESS:
            return "VK_SUCCESS";
        case VK_NOT_READY:
            return "VK_NOT_READY";
        case VK_TIMEOUT:
            return "VK_TIMEOUT";
        case VK_INCOMPLETE:
            return "VK_INCOMPLETE";
        case VK_SUBOPTIMAL_KHR:
            return "VK_SUBOPTIMAL_KHR";
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "VK_ERROR_OUT_OF_HOST_MEMORY";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "VK_ERROR_INITIALIZATION_FAILED";
        case VK_ERROR_DEVICE_LOST:
            return "VK_ERROR_DEVICE_LOST";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "VK_ERROR_MEMORY_MAP_FAILED";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "VK_ERROR_LAYER_NOT_PRESENT";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "VK_ERROR_EXTENSION_NOT_PRESENT";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "VK_ERROR_FEATURE_NOT_PRESENT";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "VK_ERROR_INCOMPATIBLE_DRIVER";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "VK_ERROR_TOO_MANY_OBJECTS";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "VK_ERROR_FORMAT_NOT_SUPPORTED";
        case VK_ERROR_FRAGMENTED_POOL:
            return "VK_ERROR_FRAGMENTED_POOL";
        case VK_ERROR_OUT_OF_POOL_MEMORY:
            return "VK_ERROR_OUT_OF_POOL_MEMORY";
        case VK_ERROR_FRAGMENTATION:
            return "VK_ERROR_FRAGMENTATION";
        case VK_ERROR_SURFACE_LOST_KHR:
            return "VK_ERROR_SURFACE_LOST_KHR";
        case VK_ERROR_OUT_OF_DATE_KHR:
            return "VK_ERROR_OUT_OF_DATE_KHR";
        case VK_ERROR_UNKNOWN:
            return "VK_ERROR_UNKNOWN";
        default:
            return fmt::format("VkResult {}", static_cast<int>(result));
    }
}

Context::Context() = default;

Context::~Context() {
    if (device != VK_NULL_HANDLE) {
        if (is_owner) vk.DeviceWaitIdle(device);
        save_pipeline_cache();
        vk.DestroyPipelineCache(device, pipeline_cache, nullptr);
        vk.DestroySampler(device, linear_sampler, nullptr);
        vk.DestroySampler(device, nearest_sampler, nullptr);
        vk.DestroySampler(device, shadow_sampler, nullptr);
        if (is_owner) vk.DestroyDevice(device, nullptr);
    }
    if (!is_owner || instance == VK_NULL_HANDLE || vk.DestroyInstance == nullptr) return;
    if (messenger != VK_NULL_HANDLE) vk.DestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
    vk.DestroyInstance(instance, nullptr);
}

void Context::say(Severity severity, std::string_view text) const {
    if (log) log(severity, text);
}

Result<> Context::check(VkResult result, std::string_view what) const {
    if (result == VK_SUCCESS) return {};
    return machine_error(fmt::format("{} failed: {}", what, result_name(result)));
}

bool Context::supports(VkFormat format, VkFormatFeatureFlags features) const {
    VkFormatProperties properties{};
    vk.GetPhysicalDeviceFormatProperties(physical_device, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

Result<> Context::finish() {
    vk.GetPhysicalDeviceMemoryProperties(physical_device, &memory);
    VkPhysicalDeviceProperties properties{};
    vk.GetPhysicalDeviceProperties(physical_device, &properties);
    traits.is_software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    traits.max_image_dimension = properties.limits.maxImageDimension2D;
    traits.sample_counts =
        properties.limits.framebufferColorSampleCounts & properties.limits.framebufferDepthSampleCounts &
        properties.limits.sampledImageColorSampleCounts & properties.limits.sampledImageDepthSampleCounts;
    traits.storage_alignment = properties.limits.minStorageBufferOffsetAlignment;
    traits.uniform_alignment = properties.limits.minUniformBufferOffsetAlignment;

    std::uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(physical_device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families.data());
    traits.timestamp_valid_bits = queue_family < count ? families[queue_family].timestampValidBits : 0;
    traits.timestamp_period_ns =
        traits.timestamp_valid_bits > 0 ? static_cast<double>(properties.limits.timestampPeriod) : 0.0;

    shaders = std::make_unique<ShaderCompiler>(cache_folder.empty() ? cache_folder : cache_folder / "shaders");
    if (Result<> samplers = create_samplers(); !samplers) return samplers;
    return create_pipeline_cache();
}

Result<> Context::create_samplers() {
    VkSamplerCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = VK_FILTER_LINEAR,
        .minFilter = VK_FILTER_LINEAR,
        .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    const VkResult linear = vk.CreateSampler(device, &create_info, nullptr, &linear_sampler);
    if (Result<> checked = check(linear, "creating the linear sampler"); !checked) return checked;
    create_info.magFilter = VK_FILTER_NEAREST;
    create_info.minFilter = VK_FILTER_NEAREST;
    const VkResult nearest = vk.CreateSampler(device, &create_info, nullptr, &nearest_sampler);
    if (Result<> checked = check(nearest, "creating the nearest sampler"); !checked) return checked;
    create_info.addressModeU = create_info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    create_info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    create_info.compareEnable = VK_TRUE;
    create_info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    return check(vk.CreateSampler(device, &create_info, nullptr, &shadow_sampler), "creating the shadow sampler");
}

std::filesystem::path Context::pipeline_cache_path() const {
    if (cache_folder.empty()) return {};
    VkPhysicalDeviceProperties properties{};
    vk.GetPhysicalDeviceProperties(physical_device, &properties);
    const Hash uuid = content_hash(std::as_bytes(std::span(properties.pipelineCacheUUID)));
    return cache_folder /
           fmt::format("pipelines_{:x}_{:x}_{:016x}.bin", properties.vendorID, properties.deviceID, uuid.low);
}

bool Context::is_own_pipeline_cache(std::span<const std::byte> data) const {
    VkPipelineCacheHeaderVersionOne header{};
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    VkPhysicalDeviceProperties properties{};
    vk.GetPhysicalDeviceProperties(physical_device, &properties);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == properties.vendorID &&
           header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

Result<> Context::create_pipeline_cache() {
    // The file is the hash of the driver's data, then the data: drivers are known to crash on damaged data, so a file
    // that does not match is ignored and written anew.
    std::vector<std::byte> file;
    std::span<const std::byte> data;
    const std::filesystem::path path = pipeline_cache_path();
    std::error_code error;
    if (!path.empty() && std::filesystem::exists(path, error)) {
        file = read_file(path).value_or(std::vector<std::byte>{});
        if (file.size() > sizeof(Hash)) {
            Hash expected;
            std::memcpy(&expected, file.data(), sizeof expected);
            data = std::span(file).subspan(sizeof expected);
            if (content_hash(data) != expected || !is_own_pipeline_cache(data)) data = {};
        }
        if (data.empty()) say(Severity::Info, fmt::format("{}: not usable, ignored", path.string()));
    }
    const VkPipelineCacheCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
        .initialDataSize = data.size(),
        .pInitialData = data.data(),
    };
    return check(vk.CreatePipelineCache(device, &create_info, nullptr, &pipeline_cache), "creating the pipeline cache");
}

void Context::save_pipeline_cache() const {
    const std::filesystem::path path = pipeline_cache_path();
    if (path.empty() || pipeline_cache == VK_NULL_HANDLE || pipelines_created == 0) return;
    std::size_t size = 0;
    if (vk.GetPipelineCacheData(device, pipeline_cache, &size, nullptr) != VK_SUCCESS || size == 0) return;
    std::vector<std::byte> bytes(sizeof(Hash) + size);
    if (vk.GetPipelineCacheData(device, pipeline_cache, &size, bytes.data() + sizeof(Hash)) != VK_SUCCESS) return;
    bytes.resize(sizeof(Hash) + size);
    const Hash hash = content_hash(std::span(bytes).subspan(sizeof(Hash)));
    std::memcpy(bytes.data(), &hash, sizeof hash);
    std::error_code error;
    std::filesystem::create_directories(cache_folder, error);
    // Without the cache the next start is slower and nothing else, so a remark is enough.
    if (const Result<> written = write_file(path, bytes); !written) say(Severity::Info, written.error().text);
}

}  // namespace darkroom::gpu
