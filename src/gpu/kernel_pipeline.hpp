// SPDX-License-Identifier: MIT
#pragma once
// From the text of a kernel to its pipeline, for gpu/kernel.cpp.

#include <string>

#include "gpu/kernel.hpp"

namespace darkroom::gpu {

[[nodiscard]] Result<VkPipeline> create_kernel_pipeline(Context& context, const KernelSpec& spec, Stage stage,
                                                        std::string source, VkPipelineLayout layout);

}  // namespace darkroom::gpu
