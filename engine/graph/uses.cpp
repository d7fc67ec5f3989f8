// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <numeric>

#include "graph/graph.hpp"

namespace darkroom::graph {

namespace {

struct UseFacts {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
    VkImageLayout layout;
    VkImageUsageFlags usage;
    bool is_write = false, keeps_content = false;
};

/// In the order of Use.
constexpr auto use_table = [] {
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                    fragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                    attachment = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    constexpr VkAccessFlags2 sampled = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                             loaded = VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                             stored = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                             blended = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                             drawn = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, uniform = VK_ACCESS_2_UNIFORM_READ_BIT;
    constexpr VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, general = VK_IMAGE_LAYOUT_GENERAL,
                            target = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, no_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    constexpr VkImageUsageFlags as_sampled = VK_IMAGE_USAGE_SAMPLED_BIT, as_storage = VK_IMAGE_USAGE_STORAGE_BIT,
                                as_target = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return std::array<UseFacts, use_count>{
        {{compute, sampled, read_only, as_sampled},
         {fragment, sampled, read_only, as_sampled},
         {compute, loaded, general, as_storage},
         {fragment, loaded, general, as_storage},
         {compute, stored, general, as_storage, true},
         {compute, loaded | stored, general, as_storage, true, true},
         {attachment, drawn, target, as_target, true},
         {attachment, blended | drawn, target, as_target, true, true},
         {compute, loaded | uniform, no_layout, 0},
         {fragment, loaded | uniform, no_layout, 0},
         {compute, stored, no_layout, 0, true},
         {compute, loaded | stored, no_layout, 0, true, true},
         {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, no_layout, 0}}};
}();
const UseFacts& facts_of(Use use) { return use_table[static_cast<std::size_t>(use)]; }

}  // namespace

bool is_write(Use use) { return facts_of(use).is_write; }
bool keeps_content(Use use) { return facts_of(use).keeps_content; }
bool is_of_buffers(Use use) { return use >= Use::BufferRead; }
VkPipelineStageFlags2 stages_of(Use use) { return facts_of(use).stages; }
VkAccessFlags2 access_of(Use use) { return facts_of(use).access; }
VkImageLayout layout_of(Use use) { return facts_of(use).layout; }
VkImageUsageFlags usage_of(Use use) { return facts_of(use).usage; }

VkExtent2D Size::of(const Extents& extents) const {
    const VkExtent2D frame = extents.of(extent);
    if (width != 0) return {width, std::max(height, 1u)};
    const auto scale = [this](std::uint32_t value) {
        const std::uint64_t scaled = std::uint64_t{value} * numerator / std::max(denominator, 1u);
        return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(scaled, 1, ~0u));
    };
    return {scale(frame.width), scale(frame.height)};
}

Size Size::scaled(std::uint32_t by_numerator, std::uint32_t by_denominator) const {
    Size out = *this;
    if (width != 0) {
        const auto side = [&](std::uint32_t value) {
            const std::uint64_t made = std::uint64_t{value} * by_numerator / std::max(by_denominator, 1u);
            return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(made, 1, ~0u));
        };
        out.width = side(width);
        out.height = side(height);
        return out;
    }
    std::uint64_t above = std::uint64_t{numerator} * by_numerator;
    std::uint64_t below = std::uint64_t{denominator} * std::max(by_denominator, 1u);
    const std::uint64_t divisor = std::gcd(above, below);
    above /= divisor;
    below /= divisor;
    // What no 32 bits hold is rounded, the same for the same fraction.
    while (above > ~0u || below > ~0u) {
        above = std::max<std::uint64_t>(above >> 1, 1);
        below = std::max<std::uint64_t>(below >> 1, 1);
    }
    out.numerator = static_cast<std::uint32_t>(above);
    out.denominator = static_cast<std::uint32_t>(below);
    return out;
}

VkExtent2D mip_extent(VkExtent2D extent, std::uint32_t mip_level) {
    return {std::max(extent.width >> mip_level, 1u), std::max(extent.height >> mip_level, 1u)};
}

}  // namespace darkroom::graph
