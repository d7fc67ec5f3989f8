// SPDX-License-Identifier: MIT
#include "render/upload/upload.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/resource/barriers.hpp"

namespace darkroom::render {

namespace {

/// Beyond this much staging memory a submission is worth its wait.
constexpr std::size_t max_staged_bytes = std::size_t{256} << 20U;

}  // namespace

Result<VkBuffer> Uploader::stage(std::size_t size, std::byte*& mapped) {
    if (staged_bytes_ > 0 && staged_bytes_ + size > max_staged_bytes) DARKROOM_TRY(flush());
    DARKROOM_TRY_VALUE(gpu::Buffer staging, gpu::Buffer::create(*context_, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                                gpu::Memory::Kind::Upload, "staging of scene assets"));
    mapped = staging.memory.mapped;
    staged_bytes_ += size;
    staging_.push_back(std::move(staging));
    return staging_.back().handle;
}

Result<gpu::Buffer> Uploader::buffer(std::span<const std::byte> bytes, VkBufferUsageFlags usage, std::size_t least_size,
                                     std::string_view name) {
    const std::size_t size = std::max(bytes.size(), least_size);
    DARKROOM_TRY_VALUE(gpu::Buffer made, gpu::Buffer::create(*context_, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                             gpu::Memory::Kind::Device, name));
    std::byte* mapped = nullptr;
    DARKROOM_TRY_VALUE(const VkBuffer source, stage(size, mapped));
    std::ranges::copy(bytes, mapped);
    std::fill(mapped + bytes.size(), mapped + size, std::byte{0});
    buffer_copies_.push_back({source, made.handle, size});
    return made;
}

Result<> Uploader::image(gpu::Image& out, VkFormat format, std::span<const Level> levels, std::string_view name) {
    DARKROOM_TRY_VALUE(
        out, gpu::Image::create(*context_, {.name = std::string(name),
                                            .format = format,
                                            .extent = {levels[0].width, levels[0].height, 1},
                                            .mip_levels = static_cast<std::uint32_t>(levels.size()),
                                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    std::size_t size = 0;
    for (const Level& level : levels) size += level.bytes.size();
    std::byte* mapped = nullptr;
    DARKROOM_TRY_VALUE(const VkBuffer source, stage(size, mapped));
    ImageCopy copy{.source = source, .target = &out, .regions = {}};
    std::size_t offset = 0;
    for (const Level& level : levels) {
        std::memcpy(mapped + offset, level.bytes.data(), level.bytes.size());
        copy.regions.push_back({.bufferOffset = offset,
                                .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                                                     .mipLevel = static_cast<std::uint32_t>(copy.regions.size()),
                                                     .layerCount = 1},
                                .imageExtent = {level.width, level.height, 1}});
        offset += level.bytes.size();
    }
    image_copies_.push_back(std::move(copy));
    return {};
}

Result<> Uploader::flush() {
    if (buffer_copies_.empty() && image_copies_.empty()) return {};
    const gpu::Dispatch& vk = context_->vk;
    Result<> done = gpu::submit_and_wait(*context_, "uploading the scene's assets", [&](VkCommandBuffer commands) {
        for (const BufferCopy& copy : buffer_copies_) {
            const VkBufferCopy region{.size = copy.size};
            vk.CmdCopyBuffer(commands, copy.source, copy.target, 1, &region);
        }
        for (const ImageCopy& copy : image_copies_) {
            gpu::transition(*context_, commands, *copy.target, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            vk.CmdCopyBufferToImage(commands, copy.source, copy.target->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    static_cast<std::uint32_t>(copy.regions.size()), copy.regions.data());
            gpu::transition(*context_, commands, *copy.target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
        gpu::record_barrier(vk, commands, gpu::copied_to,
                            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
    });
    buffer_copies_.clear();
    image_copies_.clear();
    staging_.clear();
    staged_bytes_ = 0;
    return done;
}

}  // namespace darkroom::render
