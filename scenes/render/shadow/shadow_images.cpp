// SPDX-License-Identifier: MIT
#include "render/shadow/shadow_images.hpp"

#include <fmt/format.h>

#include <vector>

#include "gpu/resource/barriers.hpp"
#include "render/shadow/casters.hpp"

namespace darkroom::render {

namespace {

/// A view of an array even where it has a single layer, as the shader's sampler wants it.
Result<> view_as_array(gpu::Context& context, gpu::Image& image) {
    if (image.info.array_layers > 1) return {};
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image.handle,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                     .format = image.info.format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    // No exception comes between the view and its owner.
    const std::string what = fmt::format("creating a view of the image \"{}\"", image.info.name);
    VkImageView view = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateImageView(context.device, &info, context.allocator, &view), what));
    context.vk.DestroyImageView(context.device, image.view, context.allocator);
    image.view = view;
    return {};
}

Result<gpu::Image> create_map(gpu::Context& context, std::string name, VkExtent2D extent, std::uint32_t layers,
                              VkImageUsageFlags usage) {
    DARKROOM_TRY_VALUE(gpu::Image image, gpu::Image::create(context, {.name = std::move(name),
                                                                      .format = shadow_map_format,
                                                                      .extent = {extent.width, extent.height, 1},
                                                                      .array_layers = layers,
                                                                      .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT}));
    DARKROOM_TRY(view_as_array(context, image));
    return image;
}

constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 reading_stages =
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

constexpr gpu::Use written{
    depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};

void change(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps,
            const gpu::Use& before, const gpu::Use& after) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const gpu::Image* map : maps) barriers.push_back(gpu::image_barrier(*map, before, after));
    gpu::record_barriers(context.vk, commands, barriers);
}

}  // namespace

Result<gpu::Image> create_shadow_map(gpu::Context& context, std::string name, VkExtent2D extent, std::uint32_t layers) {
    return create_map(context, std::move(name), extent, layers,
                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

Result<gpu::Image> create_lit_map(gpu::Context& context) {
    DARKROOM_TRY_VALUE(gpu::Image image, create_map(context, "no shadow", {1, 1}, 1, VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    Result<> cleared = gpu::submit_and_wait(context, "clearing the empty shadow map", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkClearDepthStencilValue lit{.depth = 1};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        context.vk.CmdClearDepthStencilImage(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &lit, 1,
                                             &range);
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    if (!cleared) return failure(std::move(cleared));
    return image;
}

Result<VkSampler> create_shadow_sampler(gpu::Context& context) {
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_NEAREST,
                                   .minFilter = VK_FILTER_NEAREST,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .maxLod = VK_LOD_CLAMP_NONE,
                                   .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE};
    VkSampler sampler = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateSampler(context.device, &info, context.allocator, &sampler),
                               "creating the sampler of shadow maps"));
    return sampler;
}

void begin_writing(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps) {
    change(context, commands, maps, {reading_stages}, written);
}

void begin_reading(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps) {
    change(context, commands, maps, written,
           {reading_stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

}  // namespace darkroom::render
