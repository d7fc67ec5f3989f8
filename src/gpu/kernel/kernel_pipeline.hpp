// SPDX-License-Identifier: MIT
#pragma once
// From the text of a kernel to its pipeline, for gpu/kernel/kernel.cpp.

#include <string>

#include "gpu/kernel/kernel.hpp"

namespace darkroom::gpu {

/// Behind the blocks of the frame and of the kernel.
inline constexpr std::uint32_t first_image_binding = 2;

[[nodiscard]] Result<VkPipeline> create_kernel_pipeline(Context& context, const KernelSpec& spec, Stage stage,
                                                        std::string source, VkPipelineLayout layout);

}  // namespace darkroom::gpu
