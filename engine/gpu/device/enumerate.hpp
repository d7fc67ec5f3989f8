// SPDX-License-Identifier: MIT
#pragma once
// Vulkan's lists: asked how long they are, then for what is in them.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

namespace darkroom::gpu {

/// All of a list, which is asked for again where it grew in between. Empty where it cannot be had.
template <class T, class Ask>
[[nodiscard]] VkResult enumerate(std::vector<T>& out, const Ask& ask) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        std::uint32_t count = 0;
        out.clear();
        result = ask(&count, nullptr);
        if (result != VK_SUCCESS) return result;
        out.resize(count);
        result = ask(&count, out.data());
        out.resize(result == VK_SUCCESS ? count : 0);
    }
    return result;
}

}  // namespace darkroom::gpu
