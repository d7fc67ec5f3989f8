// SPDX-License-Identifier: MIT
#pragma once
// What a Vulkan call leaves in its results when it fails is undefined (Vulkan specification, "Return Codes"), so
// whoever keeps a handle to destroy it later clears it then.

#include <vulkan/vulkan.h>

namespace darkroom::gpu {

/// The result of the call that was to write `handle`, which is none unless the call made it.
template <class Handle>
[[nodiscard]] VkResult cleared_on_failure(VkResult result, Handle& handle) {
    if (result != VK_SUCCESS) handle = VK_NULL_HANDLE;
    return result;
}

}  // namespace darkroom::gpu
