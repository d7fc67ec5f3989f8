// SPDX-License-Identifier: MIT
#include "compose/chain/tables.hpp"

#include <cstring>

#include "gpu/resource/format_use.hpp"

namespace darkroom::compose {

Result<Tables> Tables::create(gpu::Context& context, std::span<const plan::FixedImage> fixed) {
    Tables out;
    VkDeviceSize size = 0;
    std::vector<gpu::ImageInfo> infos;
    for (const plan::FixedImage& one : fixed) {
        const TableDesc& desc = one.desc;
        const bool is_neutral = one.import_index != ~0u;
        VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT;
        // A kernel that has too many storage images samples it all the same.
        if (is_neutral || desc.is_load_only) read |= VK_IMAGE_USAGE_STORAGE_BIT;
        infos.push_back({.name = desc.name,
                         .format = desc.format,
                         .extent = desc.extent,
                         .usage = read | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                         .type = desc.extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D});
        out.tables_.push_back({.offset = size,
                               .layout = (read & VK_IMAGE_USAGE_STORAGE_BIT) != 0
                                             ? VK_IMAGE_LAYOUT_GENERAL
                                             : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                               .is_nearest = !gpu::can_filter(context, desc.format)});
        // Copies start at multiples of a texel's size; 16 is the largest.
        size += (desc.data.size() + 15) / 16 * 16;
    }
    auto images = gpu::Image::create_together(context, infos, "tables of effects", out.memory_);
    if (!images) return failure(std::move(images));
    for (std::size_t i = 0; i < images->size(); ++i) out.tables_[i].image = std::move((*images)[i]);
    if (size == 0) return out;
    auto staging =
        gpu::Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, "tables");
    if (!staging) return failure(std::move(staging));
    out.staged_ = staging->handle;
    std::byte* const mapped = staging->memory.mapped;
    auto kept = std::make_unique<Staging>();
    kept->buffer = std::move(*staging);
    out.staging_ = std::move(kept);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        const auto& data = fixed[i].desc.data;
        std::memcpy(mapped + out.tables_[i].offset, data.data(), data.size());
    }
    return out;
}

void Tables::take_back(std::uint64_t recording) {
    if (uploaded_by_ == recording) uploaded_by_.reset();
}

void Tables::upload(VkCommandBuffer commands, std::uint64_t recording) {
    if (uploaded_by_) return;
    uploaded_by_ = recording;
    for (const Table& table : tables_) {
        const gpu::Dispatch& vk = table.image.context->vk;
        VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                      .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .image = table.image.handle,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        const VkDependencyInfo dependency{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
        vk.CmdPipelineBarrier2(commands, &dependency);
        const VkBufferImageCopy copy{.bufferOffset = table.offset,
                                     .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = table.image.info.extent};
        vk.CmdCopyBufferToImage(commands, staged_, table.image.handle,
                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.newLayout = table.layout;
        vk.CmdPipelineBarrier2(commands, &dependency);
    }
}

std::unique_ptr<Garbage>* Tables::spent_staging(std::uint64_t recording, std::uint64_t unfinished) {
    const bool is_finished = uploaded_by_ && recording >= *uploaded_by_ + 1 + unfinished;
    return is_finished && staging_ ? &staging_ : nullptr;
}

gpu::Binding Tables::binding(std::size_t index) const {
    const gpu::Image& image = tables_[index].image;
    const VkExtent2D size{image.info.extent.width, image.info.extent.height};
    return {.view = image.view,
            .region = {{}, size, size},
            .is_nearest = tables_[index].is_nearest,
            .layout = tables_[index].layout};
}

Result<LitShadowMap> LitShadowMap::create(gpu::Context& context) {
    // Two layers, because one would make its view no array.
    auto image = gpu::Image::create(context, {.name = "no shadow",
                                              .format = VK_FORMAT_D32_SFLOAT,
                                              .array_layers = 2,
                                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    if (!image) return failure(std::move(image));
    LitShadowMap out;
    out.image_ = std::move(*image);
    out.reference = {.image = out.image_.handle,
                     .view = out.image_.view,
                     .format = VK_FORMAT_D32_SFLOAT,
                     .extent = {1, 1},
                     .layer_count = 2,
                     .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                     .last_access = VK_ACCESS_2_MEMORY_READ_BIT,
                     .final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    return out;
}

void LitShadowMap::take_back(std::uint64_t recording) {
    if (uploaded_by_ == recording) uploaded_by_.reset();
}

void LitShadowMap::upload(VkCommandBuffer commands, std::uint64_t recording) {
    if (uploaded_by_ || image_.handle == VK_NULL_HANDLE) return;
    uploaded_by_ = recording;
    gpu::transition(*image_.context, commands, image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    constexpr VkClearDepthStencilValue lit{.depth = 1.0f};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 2};
    image_.context->vk.CmdClearDepthStencilImage(commands, image_.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &lit, 1,
                                                 &range);
    gpu::transition(*image_.context, commands, image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace darkroom::compose
