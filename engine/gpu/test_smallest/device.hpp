// SPDX-License-Identifier: MIT
#pragma once
// For tests only: the smallest device that Vulkan 1.3 allows, over the real driver. It reports the least of everything,
// and refuses each call that asks for more: the call fails, or is left out of a command buffer that then cannot be
// ended. A device that only reports would prove nothing, since the driver below takes all. Of what the extension
// VK_KHR_portability_subset makes optional, it lacks what the library could use, a comparing sampler in a descriptor.

#include <darkroom/device.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace darkroom::gpu::test {

/// While it lives, the queue of the smallest device has no graphics, and a device adopted then knows it.
class ComputeQueue {
  public:
    ComputeQueue();
    ComputeQueue(const ComputeQueue&) = delete;
    ComputeQueue& operator=(const ComputeQueue&) = delete;
    ~ComputeQueue();
};

/// One at a time.
class SmallestDevice {
  public:
    /// Over the driver of `real`, whose log hears the refusals, too, as errors.
    explicit SmallestDevice(Device real);
    SmallestDevice(const SmallestDevice&) = delete;
    SmallestDevice& operator=(const SmallestDevice&) = delete;
    ~SmallestDevice();
    /// Adopted, with the queue that tests submit to.
    [[nodiscard]] Device& device() { return *adopted_; }
    /// Once more, by who looks at another queue.
    [[nodiscard]] Device adopted() const;
    /// Messages of the validation layer so far.
    [[nodiscard]] std::uint64_t validation_messages() const { return real_.validation_messages(); }

  private:
    Device real_;
    VkPhysicalDeviceVulkan13Features features13_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features features12_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                 .pNext = &features13_};
    VkPhysicalDeviceFeatures2 features_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12_};
    std::unique_ptr<Device> adopted_;
    VkDevice handle_ = VK_NULL_HANDLE;
};

/// While it lives, refusals come here and not to the log.
class Refusals {
  public:
    Refusals();
    Refusals(const Refusals&) = delete;
    Refusals& operator=(const Refusals&) = delete;
    ~Refusals();
    [[nodiscard]] std::vector<std::string> texts() const;
    void add(std::string text);

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> texts_;
};

}  // namespace darkroom::gpu::test
