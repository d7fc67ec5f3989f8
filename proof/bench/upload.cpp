// SPDX-License-Identifier: MIT
#include "upload.hpp"

#include <algorithm>
#include <bit>

namespace darkroom::bench {

std::uint16_t half_bits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x38800000u) return 0;
    return static_cast<std::uint16_t>((bits >> 16 & 0x8000u) | ((magnitude - 0x38000000u) >> 13));
}

Result<gpu::Image> upload(gpu::Context& context, gpu::ImageInfo info, std::span<const std::byte> bytes,
                          VkImageLayout layout) {
    info.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    auto image = gpu::Image::create(context, info);
    if (!image) return image;
    DARKROOM_TRY_VALUE(auto staging, gpu::Buffer::create(context, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                         gpu::Memory::Kind::Upload, info.name));
    std::ranges::copy(bytes, staging.memory.mapped);
    auto done = gpu::submit_and_wait(context, "uploading " + info.name, [&](VkCommandBuffer commands) {
        const VkImageAspectFlags aspect =
            info.format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
        const VkBufferImageCopy copy{.imageSubresource = {.aspectMask = aspect, .layerCount = info.array_layers},
                                     .imageExtent = info.extent};
        gpu::transition(context, commands, *image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, staging.handle, image->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                        1, &copy);
        gpu::transition(context, commands, *image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    });
    if (!done) return failure(std::move(done));
    return image;
}

Result<gpu::Image> upload_table(gpu::Context& context, const TableDesc& table) {
    return upload(
        context,
        {.name = table.name, .format = table.format, .extent = table.extent, .usage = VK_IMAGE_USAGE_STORAGE_BIT},
        table.data, VK_IMAGE_LAYOUT_GENERAL);
}

}  // namespace darkroom::bench
