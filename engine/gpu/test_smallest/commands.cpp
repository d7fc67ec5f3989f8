// SPDX-License-Identifier: MIT
// Descriptors and commands of the smallest device. Recording allocates nothing here, because tests count what it
// allocates.
#include <fmt/format.h>

#include <algorithm>

#include "gpu/resource/formats.hpp"
#include "gpu/test_smallest/state.hpp"

namespace darkroom::gpu::test {

namespace {

VkFormat format_of(VkImage image) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    const auto found = state.images.find(image);
    return found == state.images.end() ? VK_FORMAT_UNDEFINED : found->second;
}

bool can(VkImage image, VkFormatFeatureFlags features) {
    return (smallest_image_features(format_of(image)) & features) == features;
}

bool is_buffer(VkDescriptorType type, bool is_uniform) {
    if (is_uniform)
        return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    return type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

std::string beyond(const VkDescriptorBufferInfo& buffer, VkDeviceSize alignment, VkDeviceSize most) {
    if (buffer.offset % alignment != 0) return fmt::format("a buffer bound at byte {}", buffer.offset);
    if (buffer.range != VK_WHOLE_SIZE && buffer.range > most)
        return fmt::format("{} bytes of a buffer bound, beyond {}", buffer.range, most);
    return {};
}

/// The caller holds the lock.
std::string beyond(const VkDescriptorImageInfo& image, VkDescriptorType type) {
    const SmallestState& state = smallest();
    const auto view = state.views.find(image.imageView);
    if (view == state.views.end()) return {};
    const VkFormatFeatureFlags features = smallest_image_features(view->second);
    if (type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && (features & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) == 0)
        return fmt::format("a storage image of format {}", format_name(view->second));
    if (type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) return {};
    if (state.comparing.contains(image.sampler)) return "a comparing sampler that is not one of the layout";
    const auto sampler = state.samplers.find(image.sampler);
    const bool is_linear = sampler != state.samplers.end() && sampler->second;
    if (is_linear && (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) == 0)
        return fmt::format("a linear filter on format {}", format_name(view->second));
    return {};
}

std::string beyond(const VkWriteDescriptorSet& write) {
    const SmallestState& state = smallest();
    std::string text;
    for (std::uint32_t index = 0; index < write.descriptorCount && text.empty(); ++index) {
        if (is_buffer(write.descriptorType, true)) {
            text = beyond(write.pBufferInfo[index], state.limits.minUniformBufferOffsetAlignment,
                          state.limits.maxUniformBufferRange);
        } else if (is_buffer(write.descriptorType, false)) {
            text = beyond(write.pBufferInfo[index], state.limits.minStorageBufferOffsetAlignment,
                          state.limits.maxStorageBufferRange);
        } else if (write.pImageInfo != nullptr) {
            text = beyond(write.pImageInfo[index], write.descriptorType);
        }
    }
    return text;
}

/// One write that is refused keeps all of the call out.
void update_sets(VkDevice device, std::uint32_t write_count, const VkWriteDescriptorSet* writes,
                 std::uint32_t copy_count, const VkCopyDescriptorSet* copies) {
    SmallestState& state = smallest();
    {
        const std::lock_guard lock(state.mutex);
        for (const VkWriteDescriptorSet& write : std::span(writes, write_count)) {
            const std::string text = beyond(write);
            if (!text.empty()) return refuse(text);
        }
    }
    state.real.UpdateDescriptorSets(device, write_count, writes, copy_count, copies);
}

VkResult begin_commands(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info) {
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    state.broken.erase(commands);
    return state.real.BeginCommandBuffer(commands, info);
}

VkResult end_commands(VkCommandBuffer commands) {
    SmallestState& state = smallest();
    const VkResult result = state.real.EndCommandBuffer(commands);
    const std::lock_guard lock(state.mutex);
    return state.broken.contains(commands) ? VK_ERROR_UNKNOWN : result;
}

void bind_sets(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipelineLayout layout, std::uint32_t first,
               std::uint32_t count, const VkDescriptorSet* sets, std::uint32_t dynamic_count,
               const std::uint32_t* dynamic_offsets) {
    SmallestState& state = smallest();
    if (first + count > state.limits.maxBoundDescriptorSets)
        return refuse(commands,
                      fmt::format("{} sets bound, beyond {}", first + count, state.limits.maxBoundDescriptorSets));
    for (const std::uint32_t offset : std::span(dynamic_offsets, dynamic_count)) {
        if (offset % state.limits.minUniformBufferOffsetAlignment != 0)
            return refuse(commands, fmt::format("a buffer bound at byte {}", offset));
    }
    state.real.CmdBindDescriptorSets(commands, point, layout, first, count, sets, dynamic_count, dynamic_offsets);
}

void push_constants(VkCommandBuffer commands, VkPipelineLayout layout, VkShaderStageFlags stages, std::uint32_t offset,
                    std::uint32_t size, const void* values) {
    if (offset + size > smallest().limits.maxPushConstantsSize)
        return refuse(commands, fmt::format("{} bytes of push constants", offset + size));
    smallest().real.CmdPushConstants(commands, layout, stages, offset, size, values);
}

void dispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint32_t most = smallest().limits.maxComputeWorkGroupCount[0];
    if (std::max({x, y, z}) > most) return refuse(commands, fmt::format("{} x {} x {} workgroups", x, y, z));
    smallest().real.CmdDispatch(commands, x, y, z);
}

/// Refuses what only a queue with graphics can do, where it has none.
bool is_graphics_refused(VkCommandBuffer commands, std::string_view what) {
    if (smallest().has_graphics) return false;
    refuse(commands, fmt::format("{} on a queue without graphics", what));
    return true;
}

void bind_pipeline(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) {
    if (point == VK_PIPELINE_BIND_POINT_GRAPHICS && is_graphics_refused(commands, "a graphics pipeline")) return;
    smallest().real.CmdBindPipeline(commands, point, pipeline);
}

void clear_depth(VkCommandBuffer commands, VkImage image, VkImageLayout layout, const VkClearDepthStencilValue* value,
                 std::uint32_t count, const VkImageSubresourceRange* ranges) {
    if (is_graphics_refused(commands, "clearing depth")) return;
    smallest().real.CmdClearDepthStencilImage(commands, image, layout, value, count, ranges);
}

void pipeline_barrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
    constexpr VkPipelineStageFlags2 of_graphics =
        VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
        VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_BLIT_BIT;
    const auto is_of_graphics = [](const auto& barrier) {
        return ((barrier.srcStageMask | barrier.dstStageMask) & of_graphics) != 0;
    };
    const bool is_asked =
        std::ranges::any_of(std::span(info->pMemoryBarriers, info->memoryBarrierCount), is_of_graphics) ||
        std::ranges::any_of(std::span(info->pImageMemoryBarriers, info->imageMemoryBarrierCount), is_of_graphics);
    if (is_asked && is_graphics_refused(commands, "a barrier with stages of graphics")) return;
    smallest().real.CmdPipelineBarrier2(commands, info);
}

void begin_rendering(VkCommandBuffer commands, const VkRenderingInfo* info) {
    if (is_graphics_refused(commands, "rendering")) return;
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    const VkRect2D& area = info->renderArea;
    if (info->colorAttachmentCount > limits.maxColorAttachments)
        return refuse(commands, fmt::format("rendering to {} images", info->colorAttachmentCount));
    if (area.offset.x + area.extent.width > limits.maxFramebufferWidth ||
        area.offset.y + area.extent.height > limits.maxFramebufferHeight)
        return refuse(commands, fmt::format("rendering to {} x {} pixels", area.extent.width, area.extent.height));
    if (info->layerCount > limits.maxFramebufferLayers)
        return refuse(commands, fmt::format("rendering to {} layers", info->layerCount));
    smallest().real.CmdBeginRendering(commands, info);
}

void set_viewport(VkCommandBuffer commands, std::uint32_t first, std::uint32_t count, const VkViewport* viewports) {
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    if (first + count > limits.maxViewports) return refuse(commands, fmt::format("{} viewports", first + count));
    const VkViewport& viewport = *viewports;
    const auto [lowest, highest] = std::pair(limits.viewportBoundsRange[0], limits.viewportBoundsRange[1]);
    if (viewport.width > static_cast<float>(limits.maxViewportDimensions[0]) ||
        std::abs(viewport.height) > static_cast<float>(limits.maxViewportDimensions[1]) || viewport.x < lowest ||
        viewport.y < lowest || viewport.x + viewport.width > highest || viewport.y + viewport.height > highest)
        return refuse(commands, fmt::format("a viewport of {} x {}", viewport.width, viewport.height));
    smallest().real.CmdSetViewport(commands, first, count, viewports);
}

void blit(VkCommandBuffer commands, VkImage source, VkImageLayout source_layout, VkImage target,
          VkImageLayout target_layout, std::uint32_t count, const VkImageBlit* regions, VkFilter filter) {
    if (is_graphics_refused(commands, "a blit")) return;
    const bool is_linear = filter != VK_FILTER_NEAREST;
    if (!can(source, VK_FORMAT_FEATURE_BLIT_SRC_BIT) || !can(target, VK_FORMAT_FEATURE_BLIT_DST_BIT))
        return refuse(commands, fmt::format("a blit from format {} to {}", format_name(format_of(source)),
                                            format_name(format_of(target))));
    if (is_linear && !can(source, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
        return refuse(commands, fmt::format("a linear filter on format {}", format_name(format_of(source))));
    smallest().real.CmdBlitImage(commands, source, source_layout, target, target_layout, count, regions, filter);
}

void write_timestamp(VkCommandBuffer commands, VkPipelineStageFlags2, VkQueryPool, std::uint32_t) {
    refuse(commands, "a timestamp");
}

}  // namespace

void replace_commands(Replacements& functions) {
    functions["vkUpdateDescriptorSets"] = as_void(update_sets);
    functions["vkBeginCommandBuffer"] = as_void(begin_commands);
    functions["vkEndCommandBuffer"] = as_void(end_commands);
    functions["vkCmdBindDescriptorSets"] = as_void(bind_sets);
    functions["vkCmdPushConstants"] = as_void(push_constants);
    functions["vkCmdDispatch"] = as_void(dispatch);
    functions["vkCmdBeginRendering"] = as_void(begin_rendering);
    functions["vkCmdBindPipeline"] = as_void(bind_pipeline);
    functions["vkCmdClearDepthStencilImage"] = as_void(clear_depth);
    functions["vkCmdPipelineBarrier2"] = as_void(pipeline_barrier);
    functions["vkCmdSetViewport"] = as_void(set_viewport);
    functions["vkCmdBlitImage"] = as_void(blit);
    functions["vkCmdWriteTimestamp2"] = as_void(write_timestamp);
}

}  // namespace darkroom::gpu::test
