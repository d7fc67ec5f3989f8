// SPDX-License-Identifier: MIT
#include "gpu/device/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <system_error>
#include <vector>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/own_file.hpp"
#include "core/system/folders.hpp"
#include "gpu/device/assumed_device.hpp"
#include "gpu/device/cleared.hpp"
#include "gpu/device/device_facts.hpp"
#include "gpu/kernel/kernel_store.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {

std::string result_name(VkResult result) {
    using Name = std::pair<VkResult, const char*>;
    constexpr std::array names{Name{VK_SUCCESS, "VK_SUCCESS"},
                               Name{VK_NOT_READY, "VK_NOT_READY"},
                               Name{VK_TIMEOUT, "VK_TIMEOUT"},
                               Name{VK_INCOMPLETE, "VK_INCOMPLETE"},
                               Name{VK_SUBOPTIMAL_KHR, "VK_SUBOPTIMAL_KHR"},
                               Name{VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY"},
                               Name{VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY"},
                               Name{VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED"},
                               Name{VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST"},
                               Name{VK_ERROR_MEMORY_MAP_FAILED, "VK_ERROR_MEMORY_MAP_FAILED"},
                               Name{VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT"},
                               Name{VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT"},
                               Name{VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT"},
                               Name{VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER"},
                               Name{VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS"},
                               Name{VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED"},
                               Name{VK_ERROR_FRAGMENTED_POOL, "VK_ERROR_FRAGMENTED_POOL"},
                               Name{VK_ERROR_OUT_OF_POOL_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY"},
                               Name{VK_ERROR_FRAGMENTATION, "VK_ERROR_FRAGMENTATION"},
                               Name{VK_ERROR_SURFACE_LOST_KHR, "VK_ERROR_SURFACE_LOST_KHR"},
                               Name{VK_ERROR_OUT_OF_DATE_KHR, "VK_ERROR_OUT_OF_DATE_KHR"},
                               Name{VK_ERROR_UNKNOWN, "VK_ERROR_UNKNOWN"}};
    const auto* const found = std::ranges::find(names, result, [](const auto& row) { return row.first; });
    return found == names.end() ? fmt::format("VkResult {}", static_cast<int>(result)) : found->second;
}

namespace {

/// What a host may do about it.
ErrorCode code_of(VkResult result) {
    switch (result) {
        case VK_ERROR_DEVICE_LOST:
            return ErrorCode::DeviceLost;
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
        case VK_ERROR_FRAGMENTED_POOL:
        case VK_ERROR_FRAGMENTATION:
        case VK_ERROR_MEMORY_MAP_FAILED:
            return ErrorCode::OutOfMemory;
        case VK_ERROR_LAYER_NOT_PRESENT:
        case VK_ERROR_EXTENSION_NOT_PRESENT:
        case VK_ERROR_FEATURE_NOT_PRESENT:
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return ErrorCode::Unsupported;
        default:
            return ErrorCode::Other;
    }
}

}  // namespace

Context::Context() = default;

Context::~Context() {
    if (device != VK_NULL_HANDLE) {
        // RADV's null device cannot even do this.
        if (is_owner && !compiles_only) vk.DeviceWaitIdle(device);
        kernels.reset();
        save_pipeline_cache_if_grown();
        if (owns_pipeline_cache_) vk.DestroyPipelineCache(device, pipeline_cache, allocator);
        vk.DestroySampler(device, linear_sampler, allocator);
        vk.DestroySampler(device, nearest_sampler, allocator);
        vk.DestroySampler(device, shadow_sampler, allocator);
        if (is_owner) vk.DestroyDevice(device, allocator);
    }
    if (!is_owner || instance == VK_NULL_HANDLE || vk.DestroyInstance == nullptr) return;
    if (messenger != VK_NULL_HANDLE) vk.DestroyDebugUtilsMessengerEXT(instance, messenger, allocator);
    vk.DestroyInstance(instance, allocator);
}

void Context::say(Severity severity, std::string_view text) const {
    if (!log) return;
    const std::lock_guard lock(log_mutex_);
    log(severity, text);
}

Result<> Context::check(VkResult result, std::string_view what) const {
    if (result == VK_SUCCESS) return {};
    return machine_error(fmt::format("{} failed: {}", what, result_name(result)), code_of(result));
}

VkFormatFeatureFlags Context::features_of(VkFormat format) const {
    if (is_assumed) return assumed_features(format);
    constexpr VkFormatFeatureFlags of_graphics = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT |
                                                 VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT |
                                                 VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
    const auto planned = [&](VkFormatFeatureFlags own) {
        if (!traits.has_graphics) own &= ~of_graphics;
        return profile ? planned_features(format, own) : own;
    };
    {
        const std::shared_lock lock(formats_mutex_);
        if (const auto known = formats_.find(format); known != formats_.end()) return planned(known->second);
    }
    VkFormatProperties properties{};
    vk.GetPhysicalDeviceFormatProperties(physical_device, format, &properties);
    const std::unique_lock lock(formats_mutex_);
    formats_.emplace(format, properties.optimalTilingFeatures);
    return planned(properties.optimalTilingFeatures);
}

bool Context::writes_without_format(VkFormat format) const {
    if (!traits.has_storage_write_without_format || is_assumed) return traits.has_storage_write_without_format;
    VkFormatProperties3 own{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3};
    VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2, .pNext = &own};
    vk.GetPhysicalDeviceFormatProperties2(physical_device, format, &properties);
    // Before Vulkan 1.3 there may be no answer by format: the feature then stands for all.
    return own.optimalTilingFeatures == 0 ||
           (own.optimalTilingFeatures & VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT) != 0;
}

bool Context::supports(VkFormat format, VkFormatFeatureFlags features) const {
    return (features_of(format) & features) == features;
}

bool Context::is_filterable(VkFormat format) const {
    return supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
}

Result<> Context::allocate_memory(const DeviceMemoryRequest& request, std::string_view what, DeviceMemory& out) const {
    const std::string place = fmt::format("allocating {} bytes of memory for {}", request.size, what);
    if (memory_hooks.allocate == nullptr) return allocate_own(request, place, out);
    // What `out` holds is given back by its owner, also where the text of an error finds no memory.
    const VkResult result = memory_hooks.allocate(memory_hooks.user, device, &request, &out);
    if (result != VK_SUCCESS) out = {};
    DARKROOM_TRY(check(result, place));
    const bool is_aligned = out.offset % std::max<VkDeviceSize>(request.alignment, 1) == 0;
    if (is_aligned && (out.mapped != nullptr || !request.is_mapped)) return {};
    const std::string given =
        is_aligned ? "not mapped" : fmt::format("at {}, which is not a multiple of {}", out.offset, request.alignment);
    free_memory(out);
    out = {};
    return user_error(fmt::format("{}: the host's memory.allocate gave memory {}", place, given));
}

Result<> Context::allocate_own(const DeviceMemoryRequest& request, const std::string& what, DeviceMemory& out) const {
    const VkMemoryDedicatedAllocateInfo dedicated{
        .sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO, .image = request.image, .buffer = request.buffer};
    const bool is_dedicated = request.prefers_dedicated || request.requires_dedicated;
    const VkMemoryAllocateInfo create_info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                           .pNext = is_dedicated ? &dedicated : nullptr,
                                           .allocationSize = request.size,
                                           .memoryTypeIndex = request.memory_type};
    const VkResult made = vk.AllocateMemory(device, &create_info, allocator, &out.memory);
    if (Result<> done = check(cleared_on_failure(made, out.memory), what); !done || !request.is_mapped) return done;
    const std::string mapping = what + ", mapping it";
    const VkResult mapped = vk.MapMemory(device, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped);
    if (mapped == VK_SUCCESS) return {};
    free_memory(out);
    out = {};
    return check(mapped, mapping);
}

void Context::free_memory(const DeviceMemory& piece) const {
    if (memory_hooks.free != nullptr) return memory_hooks.free(memory_hooks.user, device, &piece);
    vk.FreeMemory(device, piece.memory, allocator);
}

Result<> Context::finish(std::span<const std::byte> baked) {
    vk.GetPhysicalDeviceMemoryProperties(physical_device, &memory);
    VkPhysicalDeviceProperties properties{};
    vk.GetPhysicalDeviceProperties(physical_device, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    traits.is_software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    traits.sub_texel_bits = limits.subTexelPrecisionBits;
    traits.max_image_dimension = limits.maxImageDimension2D;
    traits.sample_counts = limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                           limits.sampledImageColorSampleCounts & limits.sampledImageDepthSampleCounts;
    traits.storage_alignment = limits.minStorageBufferOffsetAlignment;
    traits.uniform_alignment = limits.minUniformBufferOffsetAlignment;
    traits.max_uniform_range = limits.maxUniformBufferRange;
    traits.max_storage_range = limits.maxStorageBufferRange;
    traits.max_workgroup_invocations = limits.maxComputeWorkGroupInvocations;
    std::ranges::copy(limits.maxComputeWorkGroupSize, traits.max_workgroup_size.begin());
    traits.max_shared_bytes = limits.maxComputeSharedMemorySize;
    traits.max_storage_images =
        std::min(limits.maxPerStageDescriptorStorageImages, limits.maxFragmentCombinedOutputResources);
    traits.max_sampled_images =
        std::min(limits.maxPerStageDescriptorSampledImages, limits.maxPerStageDescriptorSamplers);

    const std::vector<VkQueueFamilyProperties> families = queue_families(vk, physical_device);
    traits.timestamp_valid_bits = queue_family < families.size() ? families[queue_family].timestampValidBits : 0;
    traits.has_graphics =
        queue_family >= families.size() || (families[queue_family].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
    traits.timestamp_period_ns = traits.timestamp_valid_bits > 0 ? static_cast<double>(limits.timestampPeriod) : 0.0;

    shaders = std::make_unique<ShaderCompiler>(cache_folder.empty() ? cache_folder : cache_folder / "shaders");
    if (!baked.empty()) {
        DARKROOM_TRY_VALUE(BakedShaders read, BakedShaders::read(baked));
        profile = read.profile();
        traits = planned_traits(traits, *profile);
        shaders->set_baked(std::move(read));
    }
    kernels = std::make_unique<KernelStore>(*this);
    DARKROOM_TRY(create_samplers());
    // A pipeline out of a cache may have no statistics.
    return pipeline_cache == VK_NULL_HANDLE && !compiles_only ? create_pipeline_cache() : Result<>{};
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
    const VkResult linear =
        cleared_on_failure(vk.CreateSampler(device, &create_info, allocator, &linear_sampler), linear_sampler);
    DARKROOM_TRY(check(linear, "creating the linear sampler"));
    create_info.magFilter = VK_FILTER_NEAREST;
    create_info.minFilter = VK_FILTER_NEAREST;
    const VkResult nearest =
        cleared_on_failure(vk.CreateSampler(device, &create_info, allocator, &nearest_sampler), nearest_sampler);
    DARKROOM_TRY(check(nearest, "creating the nearest sampler"));
    create_info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    create_info.addressModeV = create_info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    create_info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    create_info.compareEnable = VK_TRUE;
    create_info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    const VkResult shadow =
        cleared_on_failure(vk.CreateSampler(device, &create_info, allocator, &shadow_sampler), shadow_sampler);
    return check(shadow, "creating the shadow sampler");
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

std::vector<std::byte> Context::read_pipeline_cache(const std::filesystem::path& path) const {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) return {};
    // Drivers trust what they are given, so nobody else may have written it.
    if (!is_of_this_user_alone(path) || !is_of_this_user_alone(path.parent_path())) {
        say(Severity::Info, fmt::format("{}: others may write it or its folder, ignored", path.string()));
        return {};
    }
    // The file is the hash of the driver's data, then the data: drivers are known to crash on damaged data, so a file
    // that does not match is ignored and written anew.
    std::vector<std::byte> data;
    if (size <= sizeof(Hash) + max_pipeline_cache_bytes) data = read_file(path).value_or(std::vector<std::byte>{});
    if (data.size() > sizeof(Hash)) {
        Hash expected;
        std::memcpy(&expected, data.data(), sizeof expected);
        data.erase(data.begin(), data.begin() + sizeof expected);
        if (content_hash(data) == expected && is_own_pipeline_cache(data)) return data;
    }
    say(Severity::Info, fmt::format("{}: not usable, ignored", path.string()));
    return {};
}

Result<> Context::create_pipeline_cache() {
    pipeline_cache_path_ = pipeline_cache_path();
    std::vector<std::byte> data;
    if (!pipeline_cache_path_.empty()) data = read_pipeline_cache(pipeline_cache_path_);
    pipeline_cache_size_ = data.size();
    const VkPipelineCacheCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
        .initialDataSize = data.size(),
        .pInitialData = data.data(),
    };
    const VkResult created = vk.CreatePipelineCache(device, &create_info, allocator, &pipeline_cache);
    owns_pipeline_cache_ = created == VK_SUCCESS;
    return check(created, "creating the pipeline cache");
}

void Context::save_pipeline_cache_if_grown() {
    if (!owns_pipeline_cache_ || pipeline_cache_path_.empty()) return;
    if (pipelines_created == pipelines_saved_) return;
    const std::lock_guard lock(saving_mutex_);
    const std::uint64_t created = pipelines_created;
    std::size_t size = 0;
    if (vk.GetPipelineCacheData(device, pipeline_cache, &size, nullptr) != VK_SUCCESS || size == 0) return;
    if (size == pipeline_cache_size_) {
        pipelines_saved_ = created;
        return;
    }
    std::error_code error;
    if (size > max_pipeline_cache_bytes) {
        // It holds what was used long ago and cannot be thinned out: the next start begins with an empty one.
        std::filesystem::remove(pipeline_cache_path_, error);
        pipelines_saved_ = created;
        return;
    }
    std::vector<std::byte> bytes(sizeof(Hash) + size);
    // Another thread may have made it larger since; then the next call saves it.
    if (vk.GetPipelineCacheData(device, pipeline_cache, &size, bytes.data() + sizeof(Hash)) != VK_SUCCESS) return;
    bytes.resize(sizeof(Hash) + size);
    const Hash hash = content_hash(std::span(bytes).subspan(sizeof(Hash)));
    std::memcpy(bytes.data(), &hash, sizeof hash);
    make_cache_folder(cache_folder);
    // Without the cache the next start is slower and nothing else, so a remark is enough.
    if (const Result<> written = write_own_file(pipeline_cache_path_, bytes); !written) {
        say(Severity::Info, written.error().text);
    } else {
        keep_others_from_writing(pipeline_cache_path_);
    }
    pipeline_cache_size_ = size;
    pipelines_saved_ = created;
}

}  // namespace darkroom::gpu
