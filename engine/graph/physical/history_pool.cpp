// SPDX-License-Identifier: MIT
#include "graph/physical/history_pool.hpp"

#include <fmt/format.h>

#include <ranges>

#include "gpu/resource/formats.hpp"

namespace darkroom::graph {
namespace {

HistoryImages::Resampling resampling_of(const gpu::Context& context, VkFormat format) {
    constexpr VkFormatFeatureFlags blit = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT |
                                          VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    if (!context.supports(format, blit)) return HistoryImages::Resampling::None;
    // Depth is blitted without a filter, whatever its format can do (VUID-vkCmdBlitImage-srcImage-00232).
    const bool is_filtered =
        !gpu::is_depth(format) && context.supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
    return is_filtered ? HistoryImages::Resampling::Linear : HistoryImages::Resampling::Nearest;
}

bool fits(const gpu::ImageInfo& there, const Slot& slot) {
    return there.format == slot.desc.format && there.extent.width == slot.extent.width &&
           there.extent.height == slot.extent.height && there.mip_levels == slot.desc.mip_levels &&
           there.array_layers == slot.desc.array_layers;
}

}  // namespace

std::shared_ptr<HistoryImages> HistoryPool::find(const Slot& slot, std::uint32_t view_index) const {
    const auto found = images_.find({slot.history_key, view_index});
    if (slot.history_key.owner == 0 || found == images_.end()) return nullptr;
    for (const auto& weak : std::views::reverse(found->second)) {
        std::shared_ptr<HistoryImages> there = weak.lock();
        if (there && (slot.desc.is_buffer() ? there->buffer.memory.size >= slot.desc.buffer_bytes
                                            : fits(there->images[0].info, slot)))
            return there;
    }
    return nullptr;
}

Result<Histories> HistoryPool::acquire(gpu::Context& context, std::span<const Slot> slots, std::uint32_t views) {
    Histories out;
    std::vector<std::pair<std::pair<HistoryKey, std::uint32_t>, std::shared_ptr<HistoryImages>>> made;
    std::vector<gpu::ImageInfo> infos;  // two of each that is made and has images
    for (const Slot& slot : slots) {
        if (slot.kind != Slot::Kind::History && slot.kind != Slot::Kind::Lasting) continue;
        if (out.size() <= slot.history_index) out.resize(slot.history_index + 1);
        std::vector<std::shared_ptr<HistoryImages>>& of_views = out[slot.history_index];
        // The slot of the other parity may have brought them already.
        for (auto view = static_cast<std::uint32_t>(of_views.size()); view < views; ++view) {
            const std::shared_ptr<HistoryImages> there = find(slot, view);
            const VkImageUsageFlags usage = there ? there->images[0].info.usage : 0;
            if (there && (slot.desc.is_buffer() || (slot.usage & ~usage) == 0)) {
                of_views.push_back(there);
                continue;
            }
            const auto& history = of_views.emplace_back(std::make_shared<HistoryImages>());
            history->older = there;
            made.emplace_back(std::pair(slot.history_key, view), history);
            if (slot.desc.is_buffer()) {
                DARKROOM_TRY_VALUE(
                    history->buffer,
                    gpu::Buffer::create(context, slot.desc.buffer_bytes, buffer_usage, gpu::Memory::Kind::Device,
                                        fmt::format("{} of view {}", slot.desc.name, view)));
                continue;
            }
            history->resampling = resampling_of(context, slot.desc.format);
            for (std::size_t parity = 0; parity < history->images.size(); ++parity)
                infos.push_back({.name = fmt::format("{} {} of view {}", slot.desc.name, parity, view),
                                 .format = slot.desc.format,
                                 .extent = {slot.extent.width, slot.extent.height, 1},
                                 .mip_levels = slot.desc.mip_levels,
                                 .array_layers = slot.desc.array_layers,
                                 .usage = slot.usage | usage});
        }
    }
    const auto memory = std::make_shared<gpu::Memory>();
    DARKROOM_TRY_VALUE(auto images, gpu::Image::create_together(context, infos, "histories", *memory));
    auto next = images.begin();
    for (const auto& [key, history] : made) {
        if (history->buffer.handle == VK_NULL_HANDLE) {
            history->memory = memory;
            for (gpu::Image& image : history->images) image = std::move(*next++);
        }
        if (key.first.owner != 0) images_[key].push_back(history);
    }
    for (auto& [key, of_key] : images_) std::erase_if(of_key, [](const auto& weak) { return weak.expired(); });
    std::erase_if(images_, [](const auto& entry) { return entry.second.empty(); });
    return out;
}

std::shared_ptr<HistoryView> HistoryPool::view(std::uint32_t index) {
    while (views_.size() <= index) views_.push_back(std::make_shared<HistoryView>());
    return views_[index];
}

}  // namespace darkroom::graph
