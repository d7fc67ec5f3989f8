// SPDX-License-Identifier: MIT
#pragma once
// The images that shadow maps are, how they are read, and what keeps drawing into them and reading them apart.

#include <span>
#include <string>

#include "gpu/resource/resources.hpp"

namespace darkroom::render {

/// Viewed as an array, also where it has a single layer, as the shader's sampler wants it.
[[nodiscard]] Result<gpu::Image> create_shadow_map(gpu::Context& context, std::string name, VkExtent2D extent,
                                                   std::uint32_t layers);
/// One texel that no light is stopped by, ready to be read.
[[nodiscard]] Result<gpu::Image> create_lit_map(gpu::Context& context);
/// Of single texels; beyond the edge is light.
[[nodiscard]] Result<VkSampler> create_shadow_sampler(gpu::Context& context);

/// What earlier frames read is read; their depths are not needed.
void begin_writing(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps);
/// For fragment and compute shaders.
void begin_reading(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps);

}  // namespace darkroom::render
