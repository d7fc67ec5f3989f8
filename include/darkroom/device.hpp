// SPDX-License-Identifier: MIT
#pragma once
// A Device is what Darkroom runs on: created by the library (headless), or adopted from a host that already has one.
// An adopted Device owns nothing the host made, submits nothing and waits for nothing. Device functions may be called
// from any thread.
// Needs Vulkan 1.3 with synchronization2 and dynamicRendering, or Vulkan 1.2 with the extensions that these came from,
// VK_KHR_synchronization2 and VK_KHR_dynamic_rendering.

#include <vulkan/vulkan.h>
#include <cstddef>
#include <cstdint>
#include <darkroom/log.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

namespace gpu {
class Context;
}

/// Which shader stage runs the kernels; both give the same picture. `Auto` chooses per kernel, by what was measured on
/// this kind of device.
enum class KernelStage : std::uint32_t { Auto, Compute, Raster };

/// What kind of device kernels are made for ahead of time: an ordinary GPU, or a driver that runs on the CPU.
enum class DeviceProfile : std::uint32_t { Gpu, Software };

struct DeviceInfo {
    std::uint32_t index = 0;
    std::string name;
    std::string driver;
    std::uint32_t api_version = 0;
    bool is_software = false;  ///< a CPU driver
    bool is_null = false;      ///< its driver compiles for hardware that is not there, and runs nothing
    bool is_usable = false;
    std::string reason;  ///< why not, if it is not
};

struct DeviceDesc {
    /// Index, or name (or a part of it, any case); a number that is nobody's index is part of a name. Empty: a real GPU
    /// if there is one.
    std::string select;
    /// For who asks what kernels cost (Composer::statistics) and runs none: null devices are taken too, and the driver
    /// must have VK_KHR_pipeline_executable_properties. Compiling a stack to record it is then an error.
    bool compiles_only = false;
    bool validate = false;  ///< Khronos validation layer with synchronization validation; DARKROOM_VALIDATE=1 also
    LogSink log;            ///< log.hpp says from which threads it is called
    /// SPIR-V (at most 128 MiB, least recently used entries go first) and pipeline caches (at most 64 MiB each), which
    /// several processes may share. Empty: the user's cache folder.
    std::string cache_folder;
    /// False: no file is read or written. DARKROOM_SHADER_CACHE=off does the same for all devices.
    bool caches_on_disk = true;
    /// A file of kernels that KernelFile or `darkroom bake` made (darkroom/kernel_file.hpp), copied by the call. Stacks
    /// are then planned as for a device of its profile, and what is in it needs no compiler.
    std::span<const std::byte> kernels{};
    /// Enabled beside the library's own, for who shows pictures in a window: what the window system asks for, and
    /// VK_KHR_swapchain. Errors name what is missing.
    std::span<const char*const> instance_extensions{}, device_extensions{};
};

/// A piece of device memory that the library needs.
struct DeviceMemoryRequest {
    VkDeviceSize size = 0, alignment = 1;
    std::uint32_t memory_type = 0;  ///< the best one that will do; after an error the library asks for the next
    bool is_mapped = false;         ///< the type is host-visible and coherent; DeviceMemory::mapped has to be set
    /// The one image or buffer that it is for, which may have memory of its own (VkMemoryDedicatedAllocateInfo); both
    /// null where several share it.
    VkImage image = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    bool prefers_dedicated = false, requires_dedicated = false;  ///< VkMemoryDedicatedRequirements
};

/// A piece of device memory that a host gives: a range of an allocation, which may hold others.
struct DeviceMemory {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;  ///< a multiple of the alignment that was asked for
    void* mapped = nullptr;   ///< where `offset` is, until the piece is freed
    void* owner = nullptr;    ///< the host's own, such as a VmaAllocation
};

/// Who gives the library its device memory: a few large pieces for images, one for each buffer. Both functions or none.
/// They are called by whoever compiles, edits or destroys, from several threads where several do, and by the library's
/// own threads that build kernels; never by record(). `user` is handed to both.
struct DeviceMemoryHooks {
    VkResult (*allocate)(void* user, VkDevice device, const DeviceMemoryRequest* request,
                         DeviceMemory* memory) = nullptr;
    void (*free)(void* user, VkDevice device, const DeviceMemory* memory) = nullptr;
    void* user = nullptr;
};

struct AdoptDesc {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    // Vulkan cannot be asked what was enabled, so the host says it; what it does not say is taken for absent.
    /// VkApplicationInfo::apiVersion. Below 1.3, or on a device of less, the two extensions are needed and used.
    std::uint32_t api_version = VK_API_VERSION_1_3;
    /// The features and their pNext chain as given to vkCreateDevice: the structures of Vulkan 1.3 or of the
    /// extensions.
    const VkPhysicalDeviceFeatures2* enabled_features = nullptr;
    /// VkInstanceCreateInfo::ppEnabledExtensionNames. With VK_EXT_debug_utils passes and objects get names.
    std::span<const char* const> enabled_instance_extensions;
    /// VkDeviceCreateInfo::ppEnabledExtensionNames. Read on Vulkan 1.2 only.
    std::span<const char* const> enabled_device_extensions;
    PFN_vkGetInstanceProcAddr get_proc = nullptr;
    LogSink log;                           ///< as in DeviceDesc
    std::string cache_folder;              ///< as in DeviceDesc
    bool caches_on_disk = true;            ///< as in DeviceDesc
    std::span<const std::byte> kernels{};  ///< as in DeviceDesc
    /// The host's, which is then used instead of one of the library's: never saved, never destroyed, and not created
    /// with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT, since several threads build pipelines.
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
    /// Handed to every function that creates or destroys an object. Kept by pointer: it outlives the Device and all
    /// that was made on it.
    const VkAllocationCallbacks* allocator = nullptr;
    DeviceMemoryHooks memory;
};

class Device {
  public:
    /// All Vulkan devices of this machine, best first, and why any is not usable.
    [[nodiscard]] static Result<std::vector<DeviceInfo>> list();
    /// Creates a headless device. Errors: no such device (names those there are), a missing feature, VkResult.
    [[nodiscard]] static Result<Device> create(const DeviceDesc& desc = {});
    /// No device: what an ordinary one of this kind can do, for who plans stacks, bakes kernels, or only holds stacks,
    /// and needs no driver for it. Plans say that they were made so. Of a Composer on it, compile() and compile_later()
    /// are errors; images may be up to 16384 a side.
    [[nodiscard]] static Device assumed(DeviceProfile profile = DeviceProfile::Gpu);
    /// Takes the host's. Errors name every missing feature, extension and queue capability in one line.
    [[nodiscard]] static Result<Device> adopt(const AdoptDesc& desc);

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    [[nodiscard]] const DeviceInfo& info() const;
    /// Messages of the validation layer so far (0 without it).
    [[nodiscard]] std::uint64_t validation_messages() const;
    /// The library's own view of the device, for the library's other parts.
    [[nodiscard]] gpu::Context& context() const { return *context_; }
    /// The same, for who may outlive this object.
    [[nodiscard]] const std::shared_ptr<gpu::Context>& shared_context() const { return context_; }

  private:
    explicit Device(std::shared_ptr<gpu::Context> context);
    std::shared_ptr<gpu::Context> context_;
};

}  // namespace darkroom
