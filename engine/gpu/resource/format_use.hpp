// SPDX-License-Identifier: MIT
#pragma once
// What a device does with a format, beyond what the format is: whether it is read by imageLoad, and whether it is
// filtered. Where the answer is no, an image is sampled, and sampled with the nearest texel.

#include <vulkan/vulkan.h>

namespace darkroom::gpu {

class Context;

/// By imageLoad: GLSL has a name for the format, the feature it may need is enabled, and the device can.
[[nodiscard]] bool can_load(const Context& context, VkFormat format);
/// By a linear sampler.
[[nodiscard]] bool can_filter(const Context& context, VkFormat format);

}  // namespace darkroom::gpu
