// SPDX-License-Identifier: MIT
#include "compose/chain/tables.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/resource/barriers.hpp"
#include "gpu/resource/format_use.hpp"

namespace darkroom::compose {

namespace {

/// What is larger is freed by itself.
constexpr std::size_t max_bytes_together = std::size_t{1} << 20U;

bool is_same(const plan::FixedImage& a, const plan::FixedImage& b) {
    const bool is_neutral = a.import_index != ~0u, other_is_neutral = b.import_index != ~0u;
    if (a.desc.format != b.desc.format || a.desc.is_load_only != b.desc.is_load_only ||
        is_neutral != other_is_neutral || a.desc.extent.width != b.desc.extent.width ||
        a.desc.extent.height != b.desc.extent.height || a.desc.extent.depth != b.desc.extent.depth ||
        a.picture != b.picture)
        return false;
    return a.picture || a.desc.data == b.desc.data;
}

}  // namespace

Result<std::shared_ptr<Tables::Batch>> Tables::make(gpu::Context& context,
                                                    std::span<const plan::FixedImage* const> fixed) {
    auto out = std::make_shared<Batch>();
    VkDeviceSize size = 0;
    std::vector<gpu::ImageInfo> infos;
    for (const plan::FixedImage* const one : fixed) {
        const TableDesc& desc = one->desc;
        const bool is_neutral = one->import_index != ~0u;
        VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT;
        // A kernel that has too many storage images samples it all the same.
        if (is_neutral || desc.is_load_only) read |= VK_IMAGE_USAGE_STORAGE_BIT;
        infos.push_back({.name = desc.name,
                         .format = desc.format,
                         .extent = desc.extent,
                         .usage = read | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                         .type = desc.extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D});
        out->tables.push_back({.offset = size,
                               .layout = (read & VK_IMAGE_USAGE_STORAGE_BIT) != 0
                                             ? VK_IMAGE_LAYOUT_GENERAL
                                             : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                               .is_nearest = !gpu::can_filter(context, desc.format)});
        // Copies start at multiples of a texel's size; 16 is the largest.
        size += (plan::texels_of(*one).size() + 15) / 16 * 16;
    }
    DARKROOM_TRY_VALUE(auto images, gpu::Image::create_together(context, infos, "tables of effects", out->memory));
    for (std::size_t i = 0; i < images.size(); ++i) out->tables[i].image = std::move(images[i]);
    if (size == 0) return out;
    DARKROOM_TRY_VALUE(auto staging, gpu::Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                         gpu::Memory::Kind::Upload, "tables"));
    out->staged = staging.handle;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        const std::span<const std::byte> texels = plan::texels_of(*fixed[i]);
        std::memcpy(staging.memory.mapped + out->tables[i].offset, texels.data(), texels.size());
    }
    auto kept = std::make_unique<Staging>();
    kept->buffer = std::move(staging);
    out->staging = std::move(kept);
    return out;
}

Result<Tables> Tables::create(gpu::Context& context, std::span<const plan::FixedImage> images, const Tables* older,
                              std::span<const plan::FixedImage> older_images) {
    Tables out;
    std::vector<const plan::FixedImage*> together;
    std::vector<std::size_t> places_of_together;
    const auto add = [&](std::span<const plan::FixedImage* const> fixed) -> Result<> {
        DARKROOM_TRY_VALUE(auto made, make(context, fixed));
        out.batches_.push_back(std::move(made));
        return {};
    };
    const auto take_over = [&](std::size_t image) {
        if (older == nullptr) return false;
        const auto found =
            std::ranges::find_if(older_images, [&](const auto& old) { return is_same(old, images[image]); });
        if (found == older_images.end()) return false;
        const Place place = older->places_[static_cast<std::size_t>(found - older_images.begin())];
        const std::shared_ptr<Batch>& batch = older->batches_[place.batch];
        const auto known = std::ranges::find(out.batches_, batch);
        out.places_[image] = {static_cast<std::size_t>(known - out.batches_.begin()), place.table};
        if (known == out.batches_.end()) out.batches_.push_back(batch);
        return true;
    };
    out.places_.resize(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (take_over(i)) continue;
        if (plan::texels_of(images[i]).size() <= max_bytes_together) {
            together.push_back(&images[i]);
            places_of_together.push_back(i);
            continue;
        }
        const plan::FixedImage* const alone = &images[i];
        DARKROOM_TRY(add({&alone, 1}));
        out.places_[i] = {out.batches_.size() - 1, 0};
    }
    if (together.empty()) return out;
    DARKROOM_TRY(add(together));
    for (std::size_t i = 0; i < together.size(); ++i) out.places_[places_of_together[i]] = {out.batches_.size() - 1, i};
    return out;
}

void Tables::take_back(std::uint64_t recording) {
    for (const auto& batch : batches_)
        if (batch->uploaded_by == recording) batch->uploaded_by.reset();
}

void Tables::upload(VkCommandBuffer commands, std::uint64_t recording) {
    for (const auto& batch : batches_) {
        if (batch->uploaded_by) continue;
        batch->uploaded_by = recording;
        for (const Table& table : batch->tables) {
            const gpu::Dispatch& vk = table.image.context->vk;
            const VkImageMemoryBarrier2 empty = gpu::image_barrier(table.image, {}, gpu::copied_to);
            gpu::record_barriers(vk, commands, {&empty, 1});
            const VkBufferImageCopy copy{.bufferOffset = table.offset,
                                         .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                         .imageExtent = table.image.info.extent};
            vk.CmdCopyBufferToImage(commands, batch->staged, table.image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    1, &copy);
            const VkImageMemoryBarrier2 filled = gpu::image_barrier(
                table.image, gpu::copied_to,
                {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                 VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, table.layout});
            gpu::record_barriers(vk, commands, {&filled, 1});
        }
    }
}

std::unique_ptr<Garbage>* Tables::spent_staging(std::uint64_t recording, std::uint64_t unfinished) {
    for (const auto& batch : batches_)
        if (batch->staging && batch->uploaded_by && recording >= *batch->uploaded_by + 1 + unfinished)
            return &batch->staging;
    return nullptr;
}

gpu::Binding Tables::binding(std::size_t index) const {
    const Table& table = batches_[places_[index].batch]->tables[places_[index].table];
    const VkExtent2D size{table.image.info.extent.width, table.image.info.extent.height};
    return {
        .view = table.image.view, .region = {{}, size, size}, .is_nearest = table.is_nearest, .layout = table.layout};
}

Result<LitShadowMap> LitShadowMap::create(gpu::Context& context) {
    // Two layers, because one would make its view no array.
    DARKROOM_TRY_VALUE(auto image, gpu::Image::create(context, {.name = "no shadow",
                                                                .format = VK_FORMAT_D32_SFLOAT,
                                                                .array_layers = 2,
                                                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                         VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    LitShadowMap out;
    out.image_ = std::move(image);
    out.reference = {.image = out.image_.handle,
                     .view = out.image_.view,
                     .format = VK_FORMAT_D32_SFLOAT,
                     .extent = {1, 1},
                     .layer_count = 2,
                     .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                     .last_access = VK_ACCESS_2_MEMORY_READ_BIT,
                     .final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                     .final_stages = VK_PIPELINE_STAGE_2_NONE,
                     .final_access = VK_ACCESS_2_NONE};
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
