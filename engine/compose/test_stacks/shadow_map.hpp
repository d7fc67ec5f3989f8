// SPDX-License-Identifier: MIT
#pragma once
// For tests only: the cascades of a light on the CPU as the depth image that a frame brings. Not part of the library.

#include <darkroom/reference.hpp>

#include "gpu/test_run.hpp"

namespace darkroom::test {

/// A layer a cascade, left to be read by shaders; it may be copied from.
[[nodiscard]] inline gpu::Image upload_shadow_map(gpu::Context& context, const ReferenceLight& light) {
    const auto layers = static_cast<std::uint32_t>(light.cascades.size());
    // A view of one layer would be no array.
    gpu::Image image = gpu::test::must(gpu::Image::create(
        context,
        {.name = "test shadow map",
         .format = VK_FORMAT_D32_SFLOAT,
         .extent = {light.resolution, light.resolution, 1},
         .array_layers = std::max(layers, 2u),
         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    const std::size_t bytes = std::size_t{light.resolution} * light.resolution * sizeof(float);
    const gpu::Buffer staging = gpu::test::must(gpu::Buffer::create(
        context, bytes * layers, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, "test shadow map"));
    for (std::uint32_t layer = 0; layer < layers; ++layer)
        std::memcpy(staging.memory.mapped + layer * bytes, light.cascades[layer].data(), bytes);
    gpu::test::must(gpu::submit_and_wait(context, "uploading a shadow map", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, layers},
                                     .imageExtent = {light.resolution, light.resolution, 1}};
        context.vk.CmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                        &copy);
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }));
    return image;
}

[[nodiscard]] inline ImageRef shadow_map_ref(const gpu::Image& image) {
    return {.image = image.handle,
            .view = image.view,
            .format = image.info.format,
            .extent = {image.info.extent.width, image.info.extent.height},
            .layer_count = image.info.array_layers,
            .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
            .final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

}  // namespace darkroom::test
