// SPDX-License-Identifier: MIT
#pragma once
// What a driver says of a pipeline that was made with the flags for it.

#include <vulkan/vulkan.h>

#include <darkroom/kernel_statistics.hpp>

#include "core/try.hpp"

namespace darkroom::gpu {

class Context;

/// Of the program that runs `stage`; without name and workgroup. Needs a context that compiles only.
[[nodiscard]] Result<KernelStatistics> pipeline_statistics(const Context& context, VkPipeline pipeline,
                                                           VkShaderStageFlagBits stage);

}  // namespace darkroom::gpu
