// SPDX-License-Identifier: MIT
#include "graph/physical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/assert.hpp"
#include "gpu/formats.hpp"

namespace darkroom::graph {
namespace {

gpu::ImageInfo info_of(const ImageDesc& desc, VkImageUsageFlags usage, VkExtent2D extent) {
    return {.name = desc.name,
            .format = desc.format,
            .extent = {extent.width, extent.height, 1},
            .mip_levels = desc.mip_levels,
            .array_layers = desc.array_layers,
            .usage = usage};
}

}  // namespace

Measure measure_on(gpu::Context& context) {
    return [&context](const ImageDesc& desc, VkImageUsageFlags usage, VkExtent2D frame) -> Result<Requirements> {
        auto measured = gpu::Image::measure(context, info_of(desc, usage, desc.size.of(frame)));
        if (!measured) return failure(std::move(measured));
        return Requirements{measured->size, measured->alignment, measured->memoryTypeBits};
    };
}

void Physical::adopt(Entry& entry, const gpu::Image& image) {
    entry.handles.push_back(image.handle);
    entry.views.push_back(image.view);
    if (image.mip_views.empty()) {
        entry.mip_views.insert(entry.mip_views.end(), entry.mip_levels, VK_NULL_HANDLE);
    } else {
        entry.mip_views.insert(entry.mip_views.end(), image.mip_views.begin(), image.mip_views.end());
    }
}

Result<Physical> Physical::create(gpu::Context& context, const Compiled& compiled, std::uint32_t views) {
    Physical physical;
    physical.view_count_ = std::max(views, 1u);
    if (compiled.transient_bytes() > 0) {
        auto memory = gpu::Memory::create(context, compiled.transient_bytes(), compiled.memory_type_bits(),
                                          gpu::Memory::Kind::Device, "transient images");
        if (!memory) return failure(std::move(memory));
        physical.memory_ = std::move(*memory);
    }
    for (const Slot& slot : compiled.slots()) {
        Entry entry{.kind = slot.kind,
                    .format = slot.desc.format,
                    .extent = slot.extent,
                    .mip_levels = slot.desc.mip_levels,
                    .array_layers = slot.desc.array_layers,
                    .rest_layout = slot.rest_layout,
                    .import_index = slot.import_index};
        gpu::ImageInfo info = info_of(slot.desc, slot.usage, slot.extent);
        if (slot.kind == Slot::Kind::Transient) {
            auto image = gpu::Image::place(context, info, physical.memory_, slot.offset);
            if (!image) return failure(std::move(image));
            adopt(entry, *image);
            physical.images_.push_back(std::move(*image));
        } else if (slot.kind == Slot::Kind::History) {
            for (std::uint32_t index = 0; index < physical.view_count_; ++index) {
                info.name = fmt::format("{} {} of view {}", slot.desc.name, slot.history_parity, index);
                auto image = gpu::Image::create(context, info);
                if (!image) return failure(std::move(image));
                adopt(entry, *image);
                physical.images_.push_back(std::move(*image));
            }
        } else {
            entry.handles.assign(1, VK_NULL_HANDLE);
            entry.views.assign(1, VK_NULL_HANDLE);
            entry.mip_views.assign(slot.desc.mip_levels, VK_NULL_HANDLE);
        }
        physical.entries_.push_back(std::move(entry));
    }
    return physical;
}

void Physical::bind(std::uint32_t import_index, const LentImage& image) {
    // The imports are the first slots, in their order.
    DARKROOM_ASSERT(import_index < entries_.size() && entries_[import_index].import_index == import_index);
    Entry& entry = entries_[import_index];
    DARKROOM_ASSERT(image.mip_views.size() == entry.mip_levels || image.mip_views.empty());
    entry.handles[0] = image.handle;
    entry.base_mip_level = image.base_mip_level;
    entry.base_array_layer = image.base_array_layer;
    entry.array_layers = image.array_layers;
    entry.views[0] = image.view;
    std::copy(image.mip_views.begin(), image.mip_views.end(), entry.mip_views.begin());
    if (image.mip_views.empty() && entry.mip_levels == 1) entry.mip_views[0] = image.view;
}

VkImage Physical::handle(std::uint32_t slot, std::uint32_t view_index) const {
    return entries_[slot].handles[instance(entries_[slot], view_index)];
}
VkImageView Physical::view(std::uint32_t slot, std::uint32_t view_index) const {
    return entries_[slot].views[instance(entries_[slot], view_index)];
}
VkImageView Physical::mip_view(std::uint32_t slot, std::uint32_t mip_level, std::uint32_t view_index) const {
    const Entry& entry = entries_[slot];
    return entry.mip_views[instance(entry, view_index) * entry.mip_levels + mip_level];
}

void Physical::record_barriers(VkCommandBuffer commands, const gpu::Dispatch& vk, std::span<const Barrier> barriers,
                               std::uint32_t view_index) const {
    std::array<VkImageMemoryBarrier2, 32> batch;
    while (!barriers.empty()) {
        const std::size_t count = std::min(barriers.size(), batch.size());
        // A barrier of one image makes writes through that image available. What lay in the same memory before was
        // written through another one, so a transient that begins takes a barrier for all memory along.
        VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        for (std::size_t i = 0; i < count; ++i) {
            const Barrier& barrier = barriers[i];
            const Entry& entry = entries_[barrier.slot];
            batch[i] = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                        .srcStageMask = barrier.source_stages,
                        .srcAccessMask = barrier.source_access,
                        .dstStageMask = barrier.target_stages,
                        .dstAccessMask = barrier.target_access,
                        .oldLayout = barrier.old_layout,
                        .newLayout = barrier.new_layout,
                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                        .image = handle(barrier.slot, view_index),
                        .subresourceRange = {.aspectMask = barrier.is_depth_alone
                                                               ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT}
                                                               : gpu::format_traits(entry.format).aspects,
                                             .baseMipLevel = entry.base_mip_level + barrier.mips.first,
                                             .levelCount = barrier.mips.count,
                                             .baseArrayLayer = entry.base_array_layer,
                                             .layerCount = entry.array_layers}};
            DARKROOM_ASSERT(batch[i].image != VK_NULL_HANDLE);
            if (entry.kind != Slot::Kind::Transient || barrier.old_layout != VK_IMAGE_LAYOUT_UNDEFINED) continue;
            memory.srcStageMask |= barrier.source_stages;
            memory.srcAccessMask |= barrier.source_access;
            memory.dstStageMask |= barrier.target_stages;
            memory.dstAccessMask |= barrier.target_access;
        }
        const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                          .memoryBarrierCount = memory.srcAccessMask != 0 ? 1u : 0u,
                                          .pMemoryBarriers = &memory,
                                          .imageMemoryBarrierCount = static_cast<std::uint32_t>(count),
                                          .pImageMemoryBarriers = batch.data()};
        vk.CmdPipelineBarrier2(commands, &dependency);
        barriers = barriers.subspan(count);
    }
}

void Physical::record_reset(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index) const {
    const auto change = [&](const Entry& entry, VkImage image, VkImageLayout from, VkImageLayout to) {
        const bool is_first = from == VK_IMAGE_LAYOUT_UNDEFINED;
        constexpr VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        const VkImageMemoryBarrier2 barrier{
            .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = is_first ? VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT : VK_PIPELINE_STAGE_2_CLEAR_BIT,
            .srcAccessMask = is_first ? VK_ACCESS_2_MEMORY_WRITE_BIT : VK_ACCESS_2_TRANSFER_WRITE_BIT,
            .dstStageMask = is_first ? VK_PIPELINE_STAGE_2_CLEAR_BIT : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            .dstAccessMask = is_first ? VK_ACCESS_2_TRANSFER_WRITE_BIT : any,
            .oldLayout = from,
            .newLayout = to,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image,
            .subresourceRange = {gpu::format_traits(entry.format).aspects, 0, entry.mip_levels, 0, entry.array_layers}};
        const VkDependencyInfo dependency{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
        vk.CmdPipelineBarrier2(commands, &dependency);
    };
    for (const Entry& entry : entries_) {
        if (entry.kind != Slot::Kind::History) continue;
        const VkImage image = entry.handles[instance(entry, view_index)];
        const VkImageAspectFlags aspects = gpu::format_traits(entry.format).aspects;
        const VkImageSubresourceRange range{aspects, 0, entry.mip_levels, 0, entry.array_layers};
        constexpr VkImageLayout clear_layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        change(entry, image, VK_IMAGE_LAYOUT_UNDEFINED, clear_layout);
        if ((aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
            constexpr VkClearDepthStencilValue zero{};
            vk.CmdClearDepthStencilImage(commands, image, clear_layout, &zero, 1, &range);
        } else {
            constexpr VkClearColorValue zero{};
            vk.CmdClearColorImage(commands, image, clear_layout, &zero, 1, &range);
        }
        change(entry, image, clear_layout, entry.rest_layout);
    }
}

}  // namespace darkroom::graph
