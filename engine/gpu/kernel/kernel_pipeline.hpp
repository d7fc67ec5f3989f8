// SPDX-License-Identifier: MIT
#pragma once
// From the text of a kernel to its pipeline, for gpu/kernel/kernel.cpp, and the shaders that this takes, for who bakes
// them.

#include <cstdint>
#include <span>
#include <string_view>

#include "gpu/kernel/kernel.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {

/// Behind the blocks of the frame and of the kernel.
inline constexpr std::uint32_t first_image_binding = 2;
/// Behind the images and, in compute, the outputs.
[[nodiscard]] inline std::uint32_t first_buffer_binding(const KernelSpec& spec, Stage stage) {
    const std::size_t outputs = stage == Stage::Compute ? spec.outputs.size() : 0;
    return first_image_binding + static_cast<std::uint32_t>(spec.images.size() + outputs);
}

[[nodiscard]] Result<VkPipeline> create_kernel_pipeline(Context& context, const KernelSpec& spec, Stage stage,
                                                        const KernelText& text, VkPipelineLayout layout);

/// `name`: that of the spec.
[[nodiscard]] ShaderSource kernel_shader(std::string_view name, Stage stage, const KernelText& text);
/// What goes with every fragment shader: the full-screen triangle.
[[nodiscard]] ShaderSource vertex_shader();

}  // namespace darkroom::gpu
