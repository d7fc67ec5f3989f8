// SPDX-License-Identifier: MIT
#include "graph/physical/physical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/assert.hpp"
#include "gpu/resource/barriers.hpp"
#include "gpu/resource/formats.hpp"

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

constexpr VkAccessFlags2 any_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

void record_wait(VkCommandBuffer commands, const gpu::Dispatch& vk, VkPipelineStageFlags2 from,
                 VkPipelineStageFlags2 to) {
    gpu::record_barrier(vk, commands, {from, VK_ACCESS_2_MEMORY_WRITE_BIT}, {to, any_access});
}

/// Brings a whole image into another layout, after everything before and before everything after.
void record_transition(VkCommandBuffer commands, const gpu::Dispatch& vk, const gpu::Image& image, VkImageLayout from,
                       VkImageLayout to) {
    constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const VkImageMemoryBarrier2 change =
        gpu::image_barrier(image, {all, VK_ACCESS_2_MEMORY_WRITE_BIT, from}, {all, any_access, to});
    gpu::record_barriers(vk, commands, {&change, 1});
}

}  // namespace

Measure measure_on(gpu::Context& context) {
    return [&context](const ImageDesc& desc, VkImageUsageFlags usage, const Extents& frame) -> Result<Requirements> {
        const auto [width, height] = desc.size.of(frame);
        const std::uint32_t most = context.traits.max_image_dimension;
        if (width > most || height > most)
            return user_error(fmt::format("image '{}' would be {}x{}: this device allows at most {}x{}", desc.name,
                                          width, height, most, most));
        DARKROOM_TRY_VALUE(auto measured, gpu::Image::measure(context, info_of(desc, usage, desc.size.of(frame))));
        return Requirements{measured.size, measured.alignment, measured.memoryTypeBits};
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

void Physical::adopt_history(const Slot& slot, std::uint32_t index) {
    History& history = histories_[slot.history_index];
    history.slots[slot.history_parity] = index;
    if (slot.desc.is_buffer()) return;
    for (const auto& of_view : history.views) adopt(entries_[index], of_view->images[slot.history_parity]);
}

Result<Physical> Physical::create(gpu::Context& context, const Compiled& compiled, std::uint32_t views) {
    HistoryPool pool;
    return create(context, compiled, views, pool);
}

Result<Physical> Physical::create(gpu::Context& context, const Compiled& compiled, std::uint32_t views,
                                  HistoryPool& pool) {
    Physical physical;
    for (std::uint32_t index = 0; index < std::max(views, 1u); ++index) physical.views_.push_back(pool.view(index));
    physical.last_recordings_.assign(physical.views_.size(), HistoryImages::never);
    if (compiled.transient_bytes() > 0) {
        DARKROOM_TRY_VALUE(
            physical.memory_,
            gpu::Memory::create(context, {.size = compiled.transient_bytes(), .alignment = compiled.memory_alignment()},
                                compiled.memory_type_bits(), gpu::Memory::Kind::Device, "transient images"));
    }
    if (compiled.buffer_bytes() > 0) {
        DARKROOM_TRY_VALUE(physical.buffers_, gpu::Buffer::create(context, compiled.buffer_bytes(), buffer_usage,
                                                                  gpu::Memory::Kind::Device, "transient buffers"));
    }
    DARKROOM_TRY_VALUE(auto histories,
                       pool.acquire(context, compiled.slots(), static_cast<std::uint32_t>(physical.views_.size())));
    for (auto& of_views : histories) physical.histories_.push_back({.views = std::move(of_views)});
    for (const Slot& slot : compiled.slots()) {
        Entry entry{.kind = slot.kind,
                    .format = slot.desc.format,
                    .extent = slot.extent,
                    .size = slot.desc.size,
                    .mip_levels = slot.desc.mip_levels,
                    .array_layers = slot.desc.array_layers,
                    .rest_layout = slot.rest_layout,
                    .import_index = slot.import_index};
        const auto index = static_cast<std::uint32_t>(physical.entries_.size());
        physical.entries_.push_back(std::move(entry));
        Entry& kept = physical.entries_.back();
        if (slot.desc.is_buffer()) {
            kept.buffer = {physical.buffers_.handle, slot.offset, slot.desc.buffer_bytes};
            kept.history = slot.history_index;
            if (slot.kind == Slot::Kind::Lasting) physical.adopt_history(slot, index);
        } else if (slot.kind == Slot::Kind::Transient) {
            const gpu::ImageInfo info = info_of(slot.desc, slot.usage, slot.extent);
            DARKROOM_TRY_VALUE(auto image, gpu::Image::place(context, info, physical.memory_, slot.offset));
            adopt(kept, image);
            physical.images_.push_back(std::move(image));
        } else if (slot.kind == Slot::Kind::History) {
            physical.adopt_history(slot, index);
        } else {
            kept.handles.assign(1, VK_NULL_HANDLE);
            kept.views.assign(1, VK_NULL_HANDLE);
            kept.mip_views.assign(slot.desc.mip_levels, VK_NULL_HANDLE);
        }
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

Physical::BufferRange Physical::buffer(std::uint32_t slot, std::uint32_t view_index) const {
    BufferRange range = entries_[slot].buffer;
    const std::uint32_t index = entries_[slot].history;
    if (index != ~0u) range.handle = histories_[index].views[view_index]->buffer.handle;
    return range;
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
        std::uint32_t images = 0;
        // A barrier of one image makes writes through that image available. What lay in the same memory before was
        // written through another one, so a transient that begins takes a barrier for all memory along. So does a
        // buffer: drivers do no less for one.
        VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        for (const Barrier& barrier : barriers.first(count)) {
            const Entry& entry = entries_[barrier.slot];
            const bool begins = entry.kind == Slot::Kind::Transient && barrier.old_layout == VK_IMAGE_LAYOUT_UNDEFINED;
            if (begins || entry.buffer.size != 0) {
                memory.srcStageMask |= barrier.source_stages;
                memory.srcAccessMask |= barrier.source_access;
                memory.dstStageMask |= barrier.target_stages;
                memory.dstAccessMask |= barrier.target_access;
            }
            if (entry.buffer.size != 0) continue;
            const VkImageAspectFlags aspects = barrier.is_depth_alone ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT}
                                                                      : gpu::format_traits(entry.format).aspects;
            batch[images] = gpu::image_barrier(handle(barrier.slot, view_index),
                                               {aspects, entry.base_mip_level + barrier.mips.first, barrier.mips.count,
                                                entry.base_array_layer, entry.array_layers},
                                               {barrier.source_stages, barrier.source_access, barrier.old_layout},
                                               {barrier.target_stages, barrier.target_access, barrier.new_layout});
            DARKROOM_ASSERT(batch[images].image != VK_NULL_HANDLE);
            ++images;
        }
        const std::size_t all_memory = (memory.srcStageMask | memory.srcAccessMask) != 0 ? 1 : 0;
        gpu::record_barriers(vk, commands, {batch.data(), images}, {&memory, all_memory});
        barriers = barriers.subspan(count);
    }
}

HistoryImages* Physical::history(std::uint32_t history_index, std::uint32_t view_index) const {
    const bool is_used = history_index < histories_.size() && !histories_[history_index].views.empty();
    return is_used ? histories_[history_index].views[view_index].get() : nullptr;
}

bool Physical::has_same_extent(std::uint32_t history_index, const Extents& a, const Extents& b) const {
    const Entry& entry = entries_[histories_[history_index].slots[0]];
    if (entry.buffer.size != 0) return true;
    const Size& size = entry.size;
    const VkExtent2D of_a = size.of(a), of_b = size.of(b);
    return of_a.width == of_b.width && of_a.height == of_b.height;
}

std::shared_ptr<const HistoryImages> Physical::source_of(const HistoryImages& images) const {
    // The plan that the older images belong to outlives the recordings that are unfinished when this one begins;
    // whoever looks at them later must not be the one who frees them.
    std::shared_ptr<const HistoryImages> older =
        images.last_written == HistoryImages::never ? images.older.lock() : nullptr;
    return older ? older : std::shared_ptr<const HistoryImages>(std::shared_ptr<void>(), &images);
}

void Physical::prepare(const Extents& extents, bool is_related, std::uint32_t view_index) {
    HistoryView& view = histories(view_index);
    view.staged = view.now;
    view.staged.extents = extents;
    is_resampled_ = false;
    for (std::uint32_t index = 0; index < history_count(); ++index) {
        HistoryImages* const images = history(index, view_index);
        if (images == nullptr) continue;
        const std::shared_ptr<const HistoryImages> source = source_of(*images);
        images->is_valid = is_related && source->last_written == view.now.recordings;
        is_resampled_ |=
            images->is_valid && (source.get() != images || !has_same_extent(index, view.now.extents, extents));
    }
    if (!is_resampled_) return;
    // All go on in their other image, so they have one parity still.
    ++view.staged.recordings;
    for (std::uint32_t index = 0; index < history_count(); ++index) {
        HistoryImages* const images = history(index, view_index);
        if (images != nullptr && images->resampling == HistoryImages::Resampling::None)
            images->is_valid &= has_same_extent(index, view.now.extents, extents);
    }
}

void Physical::begin(VkCommandBuffer commands, const gpu::Dispatch& vk, const Schedule& schedule,
                     std::uint32_t view_index) {
    const HistoryView& view = histories(view_index);
    if (view.now.recordings > 0 && last_recordings_[view_index] != view.now.recordings) {
        // A schedule knows what its own plan does to a history, not what another one did.
        record_wait(commands, vk, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    }
    for (std::uint32_t index = 0; index < history_count(); ++index) {
        const HistoryImages* const images = history(index, view_index);
        if (images == nullptr) continue;
        const bool is_buffer = images->buffer.handle != VK_NULL_HANDLE;
        if (!is_buffer && !schedule.reads_history(index)) continue;
        if (!images->is_valid) {
            record_reset(commands, vk, view_index, index);
        } else if (is_resampled_ && !is_buffer) {
            record_resample(commands, vk, view_index, index, view.now.extents, view.staged.extents);
        }
    }
}

void Physical::end(const Schedule& schedule, std::uint32_t view_index) {
    HistoryView& view = histories(view_index);
    const std::uint64_t number = ++view.staged.recordings;
    last_recordings_[view_index] = number;
    for (std::uint32_t index = 0; index < history_count(); ++index) {
        HistoryImages* const images = history(index, view_index);
        if (images == nullptr) continue;
        images->before = images->last_written;
        if (images->buffer.handle != VK_NULL_HANDLE || schedule.writes_history(index)) images->last_written = number;
    }
    std::swap(view.now, view.staged);
}

void Physical::abandon(std::uint32_t view_index) {
    HistoryView& view = histories(view_index);
    std::swap(view.now, view.staged);
    last_recordings_[view_index] = HistoryImages::never;
    for (std::uint32_t index = 0; index < history_count(); ++index)
        if (HistoryImages* const images = history(index, view_index)) images->last_written = images->before;
}

void Physical::forget_older() {
    for (const History& history : histories_)
        for (const auto& images : history.views) images->older.reset();
}

void Physical::record_reset(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index,
                            std::uint32_t history_index) const {
    const HistoryImages* const images = history(history_index, view_index);
    if (images == nullptr) return;
    if (images->buffer.handle != VK_NULL_HANDLE) {
        record_wait(commands, vk, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT);
        vk.CmdFillBuffer(commands, images->buffer.handle, 0, VK_WHOLE_SIZE, 0);
        record_wait(commands, vk, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        return;
    }
    constexpr VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    const VkImageLayout rest = entries_[histories_[history_index].slots[0]].rest_layout;
    for (const gpu::Image& image : images->images) {
        record_transition(commands, vk, image, VK_IMAGE_LAYOUT_UNDEFINED, layout);
        const VkImageAspectFlags aspects = gpu::format_traits(image.info.format).aspects;
        const VkImageSubresourceRange range{aspects, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
        if ((aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
            constexpr VkClearDepthStencilValue zero{};
            vk.CmdClearDepthStencilImage(commands, image.handle, layout, &zero, 1, &range);
        } else {
            constexpr VkClearColorValue zero{};
            vk.CmdClearColorImage(commands, image.handle, layout, &zero, 1, &range);
        }
        record_transition(commands, vk, image, layout, rest);
    }
}

/// Repeats the last column and row of the region beyond it. A blit clamps at the edge of the image for sure, at that of
/// the region only if the driver likes ("Image Copies with Scaling" in the specification), and what lies beyond is the
/// rest of some larger frame.
void Physical::record_padding(VkCommandBuffer commands, const gpu::Dispatch& vk, const Entry& entry, VkImage image,
                              const Extents& from, const Extents& to) const {
    for (std::uint32_t mip = 0; mip < entry.mip_levels; ++mip) {
        const VkExtent2D whole = mip_extent(entry.extent, mip);
        const VkExtent2D region = mip_extent(entry.size.of(from), mip), target = mip_extent(entry.size.of(to), mip);
        const bool is_wider = target.width > region.width && region.width < whole.width;
        const bool is_higher = target.height > region.height && region.height < whole.height;
        const VkImageSubresourceLayers layers{gpu::format_traits(entry.format).aspects, mip, 0, entry.array_layers};
        const auto width = static_cast<std::int32_t>(region.width), height = static_cast<std::int32_t>(region.height);
        std::array<VkImageCopy, 3> copies;
        std::uint32_t count = 0;
        const auto copy = [&](VkOffset3D source, VkOffset3D target_offset, VkExtent3D extent) {
            copies[count++] = {layers, source, layers, target_offset, extent};
        };
        if (is_wider) copy({width - 1, 0, 0}, {width, 0, 0}, {1, region.height, 1});
        if (is_higher) copy({0, height - 1, 0}, {0, height, 0}, {region.width, 1, 1});
        if (is_wider && is_higher) copy({width - 1, height - 1, 0}, {width, height, 0}, {1, 1, 1});
        if (count == 0) continue;
        vk.CmdCopyImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, image, VK_IMAGE_LAYOUT_GENERAL, count, copies.data());
    }
}

void Physical::record_resample(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index,
                               std::uint32_t history_index, const Extents& from, const Extents& to) const {
    const HistoryImages& images = *history(history_index, view_index);
    const std::size_t parity = histories(view_index).now.recordings & 1;
    const std::shared_ptr<const HistoryImages> from_images = source_of(images);
    const gpu::Image &source = from_images->images[1 - parity], &target = images.images[parity];
    const bool stays = has_same_extent(history_index, from, to);
    const bool is_linear = !stays && images.resampling == HistoryImages::Resampling::Linear;
    const Entry& entry = entries_[histories_[history_index].slots[0]];
    constexpr VkImageLayout source_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    constexpr VkImageLayout target_layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    record_transition(commands, vk, source, entry.rest_layout, is_linear ? VK_IMAGE_LAYOUT_GENERAL : source_layout);
    record_transition(commands, vk, target, VK_IMAGE_LAYOUT_UNDEFINED, target_layout);
    if (is_linear) {
        record_padding(commands, vk, entry, source.handle, from, to);
        record_transition(commands, vk, source, VK_IMAGE_LAYOUT_GENERAL, source_layout);
    }
    for (std::uint32_t mip = 0; mip < entry.mip_levels; ++mip) {
        const auto corner = [&](const Extents& frame) {
            const VkExtent2D extent = mip_extent(entry.size.of(frame), mip);
            return VkOffset3D{static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height), 1};
        };
        const VkImageSubresourceLayers layers{gpu::format_traits(entry.format).aspects, mip, 0, entry.array_layers};
        if (stays) {
            const VkExtent2D extent = mip_extent(entry.size.of(to), mip);
            const VkImageCopy copy{layers, {}, layers, {}, {extent.width, extent.height, 1}};
            vk.CmdCopyImage(commands, source.handle, source_layout, target.handle, target_layout, 1, &copy);
            continue;
        }
        const VkImageBlit blit{layers, {{}, corner(from)}, layers, {{}, corner(to)}};
        vk.CmdBlitImage(commands, source.handle, source_layout, target.handle, target_layout, 1, &blit,
                        is_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
    }
    record_transition(commands, vk, source, source_layout, entry.rest_layout);
    record_transition(commands, vk, target, target_layout, entry.rest_layout);
}

}  // namespace darkroom::graph
