// SPDX-License-Identifier: MIT
#pragma once
// A Device is what Darkroom runs on: created by the library (headless), or adopted from a host that already has one.
// An adopted Device owns nothing the host made, submits nothing and waits for nothing. Device functions may be called
// from any thread; a Device outlives the Composers made on it.
// Needs Vulkan 1.3 with synchronization2 and dynamicRendering.

#include <vulkan/vulkan.h>
#include <cstdint>
#include <darkroom/log.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
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

struct DeviceInfo {
    std::uint32_t index = 0;
    std::string name;
    std::string driver;
    std::uint32_t api_version = 0;
    bool is_software = false;  ///< a CPU driver
    bool is_usable = false;
    std::string reason;  ///< why not, if it is not
};

struct DeviceDesc {
    std::string select;     ///< name (or a part of it, any case) or index; empty: a real GPU if there is one
    bool validate = false;  ///< Khronos validation layer with synchronization validation; DARKROOM_VALIDATE=1 also
    LogSink log;
    std::filesystem::path cache_folder;  ///< SPIR-V and pipeline caches; empty: the user's cache folder
};

struct AdoptDesc {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    /// The pNext chain the host gave to vkCreateDevice. Vulkan cannot be asked what was enabled, so the host says it.
    const VkPhysicalDeviceFeatures2* enabled_features = nullptr;
    std::span<const char* const> enabled_extensions;
    PFN_vkGetInstanceProcAddr get_proc = nullptr;
    LogSink log;
    std::filesystem::path cache_folder;
};

class Device {
  public:
    /// All Vulkan devices of this machine, best first, and why any is not usable.
    [[nodiscard]] static Result<std::vector<DeviceInfo>> list();
    /// Creates a headless device. Errors: no such device (names those there are), a missing feature, VkResult.
    [[nodiscard]] static Result<Device> create(const DeviceDesc& desc = {});
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

  private:
    explicit Device(std::shared_ptr<gpu::Context> context);
    std::shared_ptr<gpu::Context> context_;
};

}  // namespace darkroom
