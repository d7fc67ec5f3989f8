// SPDX-License-Identifier: MIT
#pragma once
// What the library knows of a Vulkan device: handles, one dispatch table through which every call goes (a test puts a
// null or counting one in its place), traits, caches. Everything in gpu/ hangs on a Context.

#include <vulkan/vulkan.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <darkroom/device.hpp>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/try.hpp"
#include "gpu/device/dispatch.hpp"

namespace darkroom::gpu {

class KernelStore;
class ShaderCompiler;

struct Traits {
    bool is_software = false;
    bool has_graphics = true;                   ///< the queue family; without, no image is rendered to or blitted
    bool has_extended_storage_formats = false;  ///< shaderStorageImageExtendedFormats: r8, rg16f, r11f_g11f_b10f ...
    bool has_storage_write_without_format = false;
    bool has_debug_labels = false;
    bool has_host_query_reset = false;                         ///< hostQueryReset
    bool has_robust_images = false;                            ///< robustImageAccess
    bool has_wireframe = false;                                ///< fillModeNonSolid
    bool has_depth_clamp = false;                              ///< depthClamp
    VkSampleCountFlags sample_counts = VK_SAMPLE_COUNT_1_BIT;  ///< of colour and depth attachments that are sampled
    std::uint32_t max_image_dimension = 0;
    VkDeviceSize storage_alignment = 256, uniform_alignment = 256;
    // Until a device says more: the least that Vulkan promises.
    std::uint32_t max_uniform_range = 16384;                  ///< bytes of one uniform buffer that a shader sees
    VkDeviceSize max_storage_range = VkDeviceSize{1} << 27U;  ///< the same of a storage buffer
    std::uint32_t max_workgroup_invocations = 128;
    std::array<std::uint32_t, 3> max_workgroup_size{128, 128, 64};
    std::uint32_t max_shared_bytes = 16384;  ///< of a workgroup
    std::uint32_t max_storage_images = 4;    ///< a stage; of a fragment shader with its outputs
    std::uint32_t max_sampled_images = 16;   ///< a stage, each with a sampler
    std::uint32_t sub_texel_bits = 4;        ///< a linear sampler's steps from texel to texel are 2 to this power
    double timestamp_period_ns = 0;          ///< 0: this queue family has no timestamps
    std::uint32_t timestamp_valid_bits = 0;  ///< the counter goes round after them
};

class Context {
  public:
    Context();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    Dispatch vk{};
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    VkQueue queue = VK_NULL_HANDLE;  ///< only where the library created the device
    std::mutex queue_mutex;          ///< held while something is submitted to it
    bool is_owner = false;           ///< of instance, device and messenger
    bool is_assumed = false;         ///< there is no device: gpu/device/assumed_device.hpp
    /// What is planned here is planned as for an assumed device of this kind: it is one, or its kernels were baked.
    std::optional<DeviceProfile> profile;
    bool compiles_only = false;  ///< as in DeviceDesc: no image may be made, nothing submitted
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    const VkAllocationCallbacks* allocator = nullptr;  ///< of every object that is created or destroyed
    DeviceMemoryHooks memory_hooks{};                  ///< empty: vkAllocateMemory
    std::shared_ptr<const void> memory_hooks_owner;    ///< of their `user`, where an interface over this one made it
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;   ///< finish() makes one unless the host's is here already
    std::size_t max_pipeline_cache_bytes = std::size_t{64} << 20U;  ///< a larger one is not kept
    VkSampler linear_sampler = VK_NULL_HANDLE, nearest_sampler = VK_NULL_HANDLE;
    VkSampler shadow_sampler = VK_NULL_HANDLE;  ///< compares with LESS_OR_EQUAL, lit outside
    VkPhysicalDeviceMemoryProperties memory{};
    Traits traits{};
    DeviceInfo info{};
    LogSink log;
    std::atomic<std::uint64_t> validation_messages{0};
    std::atomic<std::uint64_t> pipelines_created{0};  ///< counted for the tests of idea 5
    std::mutex full_screen_mutex;                     ///< guards the next member
    std::vector<std::uint32_t> full_screen_vertex;    ///< SPIR-V of the triangle, compiled by the first raster kernel
    std::filesystem::path cache_folder;               ///< empty: none
    std::unique_ptr<ShaderCompiler> shaders;
    std::unique_ptr<KernelStore> kernels;

    /// To the log, from any thread; one thread at a time gets through.
    void say(Severity severity, std::string_view text) const;
    /// The one place where a VkResult becomes an Error: "<what> failed: VK_ERROR_...".
    [[nodiscard]] Result<> check(VkResult result, std::string_view what) const;
    /// For images with optimal tiling. The driver is asked once a format; any thread may call.
    [[nodiscard]] bool supports(VkFormat format, VkFormatFeatureFlags features) const;
    /// Whether a linear sampler may read it.
    [[nodiscard]] bool is_filterable(VkFormat format) const;
    /// Whether a kernel may write to it by a storage image that names no format.
    [[nodiscard]] bool writes_without_format(VkFormat format) const;

    /// From the host's hooks or the driver; `what` is for the error.
    [[nodiscard]] Result<> allocate_memory(const DeviceMemoryRequest&, std::string_view what, DeviceMemory&) const;
    void free_memory(const DeviceMemory& piece) const;

    /// Writes the pipeline cache to its file if pipelines have been made since it was read or written: after a compile,
    /// from any thread. Costs a comparison where nothing is new. Of several processes the last one's file stays.
    void save_pipeline_cache_if_grown();

    /// Makes what every use of the device needs: samplers, pipeline cache, shader compiler, memory properties, limits.
    /// Called once by Device, when dispatch table, handles and traits that depend on enabled features are set.
    /// `kernels`: as in DeviceDesc.
    [[nodiscard]] Result<> finish(std::span<const std::byte> kernels);

  private:
    [[nodiscard]] Result<> allocate_own(const DeviceMemoryRequest&, const std::string& what, DeviceMemory&) const;
    [[nodiscard]] Result<> create_samplers();
    [[nodiscard]] Result<> create_pipeline_cache();
    [[nodiscard]] std::filesystem::path pipeline_cache_path() const;
    [[nodiscard]] std::vector<std::byte> read_pipeline_cache(const std::filesystem::path& path) const;
    [[nodiscard]] bool is_own_pipeline_cache(std::span<const std::byte> data) const;
    [[nodiscard]] VkFormatFeatureFlags features_of(VkFormat format) const;

    // Recursive, because a sink may itself make a call that has something to say.
    mutable std::recursive_mutex log_mutex_;
    mutable std::shared_mutex formats_mutex_;  ///< guards the next member
    mutable std::unordered_map<VkFormat, VkFormatFeatureFlags> formats_;
    bool owns_pipeline_cache_ = false;
    std::filesystem::path pipeline_cache_path_;  ///< empty: not saved
    std::atomic<std::uint64_t> pipelines_saved_{0};
    std::mutex saving_mutex_;  ///< guards the next member
    std::size_t pipeline_cache_size_ = 0;
};

/// "VK_ERROR_DEVICE_LOST" and so on.
[[nodiscard]] std::string result_name(VkResult result);

}  // namespace darkroom::gpu
