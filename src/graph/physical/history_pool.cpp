// SPDX-License-Identifier: MIT
#include "graph/physical/history_pool.hpp"

#include <fmt/format.h>

namespace darkroom::graph {
namespace {

bool is_depth(VkFormat format) { return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT; }

HistoryImages::Resampling resampling_of(const gpu::Context& context, VkFormat format) {
    constexpr VkFormatFeatureFlags blit = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT |
                                          VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    if (!context.supports(format, blit)) return HistoryImages::Resampling::None;
    // Depth is blitted without a filter, whatever its format can do (VUID-vkCmdBlitImage-srcImage-00232).
    const bool is_filtered =
        !is_depth(format) && context.supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
    return is_filtered ? HistoryImages::Resampling::Linear : HistoryImages::Resampling::Nearest;
}

bool fits(const gpu::ImageInfo& there, const Slot& slot) {
    return there.format == slot.desc.format && there.extent.width == slot.extent.width &&
           there.extent.height == slot.extent.height && there.mip_levels == slot.desc.mip_levels &&
           there.array_layers == slot.desc.array_layers && (slot.usage & ~there.usage) == 0;
}

}  // namespace

Result<std::shared_ptr<HistoryImages>> HistoryPool::acquire(gpu::Context& context, const Slot& slot,
                                                            std::uint32_t view_index) {
    const bool is_shared = slot.history_key.owner != 0;
    const std::pair key(slot.history_key, view_index);
    if (is_shared) {
        const auto found = images_.find(key);
        const auto is_there = [&](const HistoryImages& there) {
            return slot.desc.is_buffer() ? there.buffer.memory.size >= slot.desc.buffer_bytes
                                         : fits(there.images[0].info, slot);
        };
        if (found != images_.end() && is_there(*found->second)) return found->second;
    }
    auto made = std::make_shared<HistoryImages>();
    if (slot.desc.is_buffer()) {
        auto buffer = gpu::Buffer::create(context, slot.desc.buffer_bytes, buffer_usage, gpu::Memory::Kind::Device,
                                          fmt::format("{} of view {}", slot.desc.name, view_index));
        if (!buffer) return failure(std::move(buffer));
        made->buffer = std::move(*buffer);
        if (is_shared) images_[key] = made;
        return made;
    }
    made->resampling = resampling_of(context, slot.desc.format);
    VkImageUsageFlags usage = slot.usage;
    if (made->resampling != HistoryImages::Resampling::None) usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    for (std::size_t parity = 0; parity < made->images.size(); ++parity) {
        auto image =
            gpu::Image::create(context, {.name = fmt::format("{} {} of view {}", slot.desc.name, parity, view_index),
                                         .format = slot.desc.format,
                                         .extent = {slot.extent.width, slot.extent.height, 1},
                                         .mip_levels = slot.desc.mip_levels,
                                         .array_layers = slot.desc.array_layers,
                                         .usage = usage});
        if (!image) return failure(std::move(image));
        made->images[parity] = std::move(*image);
    }
    if (is_shared) images_[key] = made;
    return made;
}

std::shared_ptr<HistoryView> HistoryPool::view(std::uint32_t index) {
    while (views_.size() <= index) views_.push_back(std::make_shared<HistoryView>());
    return views_[index];
}

void HistoryPool::trim() {
    std::erase_if(images_, [](const auto& entry) { return entry.second.use_count() == 1; });
}

}  // namespace darkroom::graph
