// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>

#include "graph/graph.hpp"

namespace darkroom::graph {

bool is_write(Use use) {
    switch (use) {
        case Use::StorageWrite:
        case Use::StorageReadWrite:
        case Use::ColorWrite:
        case Use::ColorBlend:
        case Use::BufferWrite:
        case Use::BufferReadWrite:
            return true;
        default:
            return false;
    }
}

bool keeps_content(Use use) {
    return use == Use::StorageReadWrite || use == Use::ColorBlend || use == Use::BufferReadWrite;
}

bool is_of_buffers(Use use) { return use >= Use::BufferRead; }

VkPipelineStageFlags2 stages_of(Use use) {
    switch (use) {
        case Use::SampledCompute:
        case Use::SampledGeneralCompute:
        case Use::StorageRead:
        case Use::StorageWrite:
        case Use::StorageReadWrite:
        case Use::BufferRead:
        case Use::BufferWrite:
        case Use::BufferReadWrite:
            return VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
        case Use::SampledFragment:
        case Use::SampledGeneralFragment:
        case Use::StorageReadFragment:
        case Use::BufferReadFragment:
            return VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
        case Use::BufferCopy:
            return VK_PIPELINE_STAGE_2_COPY_BIT;
        case Use::ColorWrite:
        case Use::ColorBlend:
            return VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    }
    return VK_PIPELINE_STAGE_2_NONE;
}

VkAccessFlags2 access_of(Use use) {
    switch (use) {
        case Use::SampledCompute:
        case Use::SampledFragment:
        case Use::SampledGeneralCompute:
        case Use::SampledGeneralFragment:
            return VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        case Use::StorageRead:
        case Use::StorageReadFragment:
            return VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
        case Use::StorageWrite:
        case Use::BufferWrite:
            return VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
        case Use::BufferRead:
        case Use::BufferReadFragment:
            return VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
        case Use::BufferCopy:
            return VK_ACCESS_2_TRANSFER_READ_BIT;
        case Use::BufferReadWrite:
        case Use::StorageReadWrite:
            return VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
        case Use::ColorWrite:
            return VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
        case Use::ColorBlend:
            return VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    }
    return VK_ACCESS_2_NONE;
}

VkImageLayout layout_of(Use use) {
    switch (use) {
        case Use::SampledCompute:
        case Use::SampledFragment:
            return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        case Use::ColorWrite:
        case Use::ColorBlend:
            return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        default:
            return is_of_buffers(use) ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL;
    }
}

VkImageUsageFlags usage_of(Use use) {
    switch (use) {
        case Use::SampledCompute:
        case Use::SampledFragment:
        case Use::SampledGeneralCompute:
        case Use::SampledGeneralFragment:
            return VK_IMAGE_USAGE_SAMPLED_BIT;
        case Use::StorageRead:
        case Use::StorageReadFragment:
        case Use::StorageWrite:
        case Use::StorageReadWrite:
            return VK_IMAGE_USAGE_STORAGE_BIT;
        case Use::ColorWrite:
        case Use::ColorBlend:
            return VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        default:
            return 0;
    }
}

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
