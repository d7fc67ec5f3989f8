// SPDX-License-Identifier: MIT
#pragma once
// The system's Vulkan loader, opened when the library makes a device of its own. Nothing is linked: a host that has a
// device brings its own vkGetInstanceProcAddr, and may have no loader at all.

#include <vulkan/vulkan.h>

#include <darkroom/device.hpp>
#include <darkroom/result.hpp>
#include <memory>

#include "core/system/module.hpp"

namespace darkroom::gpu {

/// vkGetInstanceProcAddr of the loader, which stays open to the end of the process.
[[nodiscard]] Result<PFN_vkGetInstanceProcAddr> open_vulkan_loader(const char* library = vulkan_loader_name);

/// What Device::create() makes, by the functions of a loader.
[[nodiscard]] Result<std::shared_ptr<Context>> create_context(PFN_vkGetInstanceProcAddr loader, const DeviceDesc& desc);

}  // namespace darkroom::gpu
