// SPDX-License-Identifier: MIT
#include "render/targets.hpp"

#include <vector>

#include "gpu/resource/barriers.hpp"

namespace darkroom::render {

namespace {

constexpr VkPipelineStageFlags2 color_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkAccessFlags2 color_access = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 depth_access =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkPipelineStageFlags2 copy_stages = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_BLIT_BIT;

using gpu::Use;

/// Of the host and its effects, which it knows and we do not; what they left is not needed.
constexpr Use unknown_use{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr Use color_attachment{color_stage, color_access, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr Use depth_attachment{depth_stages, depth_access, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};

class Barriers {
  public:
    void add(const gpu::Image& image, const Use& before, const Use& after) {
        if (image.handle == VK_NULL_HANDLE) return;
        list_.push_back(gpu::image_barrier(image, before, after));
    }
    void record(const gpu::Context& context, VkCommandBuffer commands) const {
        gpu::record_barriers(context.vk, commands, list_);
    }

  private:
    std::vector<VkImageMemoryBarrier2> list_;
};

VkImageUsageFlags final_usage(const gpu::Context& context, VkFormat format) {
    VkImageUsageFlags usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return usage;
}

VkRenderingAttachmentInfo attachment(const gpu::Image& image, VkImageLayout layout, VkAttachmentLoadOp load) {
    return {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = image.view,
            .imageLayout = layout,
            .loadOp = load,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
}

}  // namespace

ResolveUse use_of(const gpu::Kernel& kernel) {
    if (kernel.stage() == gpu::Stage::Raster) return {};
    return {.stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .write_stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .write_access = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            .write_layout = VK_IMAGE_LAYOUT_GENERAL};
}

Result<Targets> Targets::create(gpu::Context& context, const TargetsDesc& desc) {
    const TargetFormats& formats = desc.formats;
    const bool has_layers = formats.has_layers, has_many = formats.samples != VK_SAMPLE_COUNT_1_BIT;
    const VkImageUsageFlags read_usage = has_layers ? VkImageUsageFlags{VK_IMAGE_USAGE_SAMPLED_BIT} : 0;
    const VkImageUsageFlags many_usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | read_usage;
    const VkImageUsageFlags depth_usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | read_usage;
    Targets out;
    out.context_ = &context;
    out.desc_ = desc;
    struct Wanted {
        gpu::Image& image;
        bool is_wanted;
        const char* name;
        VkFormat format;
        VkImageUsageFlags usage;
        VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    };
    constexpr VkFormat distance = VK_FORMAT_R32_SFLOAT;
    const std::array wanted{
        Wanted{out.color, true, "scene colour", formats.color, final_usage(context, formats.color)},
        Wanted{out.normals, has_layers, "scene normals", formats.normals, final_usage(context, formats.normals)},
        Wanted{out.velocity, has_layers, "scene velocity", formats.velocity, final_usage(context, formats.velocity)},
        Wanted{out.planar_depth, has_layers, "scene distance", distance, final_usage(context, distance)},
        Wanted{out.transparency, desc.has_transparency, "scene before transparency", formats.color,
               final_usage(context, formats.color) | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
        Wanted{out.depth, true, "scene depth", formats.depth, depth_usage, formats.samples},
        Wanted{out.many_color, has_many, "colour samples", formats.color, many_usage, formats.samples},
        Wanted{out.many_normals, has_many && has_layers, "normal samples", formats.normals, many_usage,
               formats.samples},
        Wanted{out.many_velocity, has_many && has_layers, "velocity samples", formats.velocity, many_usage,
               formats.samples}};
    for (const Wanted& one : wanted) {
        if (!one.is_wanted) continue;
        DARKROOM_TRY_VALUE(one.image, gpu::Image::create(context, {.name = one.name,
                                                                   .format = one.format,
                                                                   .extent = {desc.extent.width, desc.extent.height, 1},
                                                                   .usage = one.usage,
                                                                   .samples = one.samples}));
    }
    return out;
}

void Targets::begin(VkCommandBuffer commands, const std::array<float, 4>& background, const ResolveUse& resolve) const {
    const bool has_many = is_multi_sampled();
    // Samples were last read by the resolve of the frame before, or written by what had no resolve pass.
    const Use samples_before = has_layers() ? Use{resolve.stage, 0} : Use{color_stage, color_access};
    Barriers barriers;
    for (const gpu::Image* image : {&many_color, &many_normals, &many_velocity})
        barriers.add(*image, samples_before, color_attachment);
    if (!has_many) {
        for (const gpu::Image* image : {&color, &normals, &velocity})
            barriers.add(*image, unknown_use, color_attachment);
    } else if (!has_layers()) {
        barriers.add(color, unknown_use, color_attachment);
    }
    barriers.add(depth, has_layers() ? Use{resolve.stage, 0} : Use{depth_stages, depth_access}, depth_attachment);
    barriers.record(*context_, commands);
    begin_rendering(commands, VK_ATTACHMENT_LOAD_OP_CLEAR, background);
    const VkViewport viewport{0, 0, static_cast<float>(desc_.extent.width), static_cast<float>(desc_.extent.height),
                              0, 1};
    const VkRect2D area{{0, 0}, desc_.extent};
    context_->vk.CmdSetViewport(commands, 0, 1, &viewport);
    context_->vk.CmdSetScissor(commands, 0, 1, &area);
}

void Targets::begin_rendering(VkCommandBuffer commands, VkAttachmentLoadOp load,
                              const std::array<float, 4>& background) const {
    const bool has_many = is_multi_sampled();
    const auto color_attachment_of = [load](const gpu::Image& image) {
        return attachment(image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, load);
    };
    std::vector<VkRenderingAttachmentInfo> colors{color_attachment_of(has_many ? many_color : color)};
    colors[0].clearValue.color = {{background[0], background[1], background[2], background[3]}};
    if (has_layers()) {
        colors.push_back(color_attachment_of(has_many ? many_normals : normals));
        colors.push_back(color_attachment_of(has_many ? many_velocity : velocity));
    } else if (has_many) {
        colors[0].resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        colors[0].resolveImageView = color.view;
        colors[0].resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        colors[0].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    }
    VkRenderingAttachmentInfo depth_info = attachment(depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, load);
    if (!has_layers()) depth_info.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkRect2D area{{0, 0}, desc_.extent};
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = area,
                               .layerCount = 1,
                               .colorAttachmentCount = static_cast<std::uint32_t>(colors.size()),
                               .pColorAttachments = colors.data(),
                               .pDepthAttachment = &depth_info};
    context_->vk.CmdBeginRendering(commands, &info);
}

void Targets::copy_before_transparency(VkCommandBuffer commands) const {
    context_->vk.CmdEndRendering(commands);
    using gpu::copied_from, gpu::copied_to;
    Barriers before;
    before.add(color, color_attachment, copied_from);
    before.add(transparency, unknown_use, copied_to);
    before.record(*context_, commands);
    const VkImageCopy region{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .extent = {desc_.extent.width, desc_.extent.height, 1}};
    context_->vk.CmdCopyImage(commands, color.handle, copied_from.layout, transparency.handle, copied_to.layout, 1,
                              &region);
    Barriers after;
    after.add(color, copied_from, color_attachment);
    for (const gpu::Image* image : {&normals, &velocity}) after.add(*image, color_attachment, color_attachment);
    after.add(depth, depth_attachment, depth_attachment);
    after.record(*context_, commands);
    begin_rendering(commands, VK_ATTACHMENT_LOAD_OP_LOAD, {});
}

void Targets::end_for_resolve(VkCommandBuffer commands, const ResolveUse& resolve) const {
    context_->vk.CmdEndRendering(commands);
    const Use read{resolve.stage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const Use written{resolve.write_stage, resolve.write_access, resolve.write_layout};
    Barriers barriers;
    barriers.add(depth, depth_attachment, read);
    barriers.add(planar_depth, unknown_use, written);
    for (const gpu::Image* image : {&many_color, &many_normals, &many_velocity})
        barriers.add(*image, color_attachment, read);
    if (is_multi_sampled())
        for (const gpu::Image* image : {&color, &normals, &velocity}) barriers.add(*image, unknown_use, written);
    barriers.record(*context_, commands);
}

void Targets::end_for_copy(VkCommandBuffer commands) const {
    context_->vk.CmdEndRendering(commands);
    Barriers barriers;
    barriers.add(color, color_attachment,
                 {copy_stages, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    barriers.record(*context_, commands);
}

ImageRef Targets::drawn(const gpu::Image& image, const ResolveUse& resolve) const {
    return drawn(image, resolve, is_multi_sampled() || image.handle == planar_depth.handle);
}

ImageRef Targets::written(const gpu::Image& image, const ResolveUse& writer) const {
    return drawn(image, writer, true);
}

ImageRef Targets::drawn(const gpu::Image& image, const ResolveUse& resolve, bool is_resolved) const {
    return {.image = image.handle,
            .view = image.view,
            .format = image.info.format,
            .extent = desc_.extent,
            .layout = is_resolved ? resolve.write_layout : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            .last_stages = is_resolved ? resolve.write_stage : color_stage,
            .last_access = is_resolved ? resolve.write_access : VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
}

ImageRef Targets::copied_transparency() const {
    if (transparency.handle == VK_NULL_HANDLE) return {};
    return {.image = transparency.handle,
            .view = transparency.view,
            .format = transparency.info.format,
            .extent = desc_.extent,
            .layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            .last_stages = VK_PIPELINE_STAGE_2_COPY_BIT,
            .last_access = VK_ACCESS_2_TRANSFER_WRITE_BIT};
}

ImageRef Targets::copied_picture() const {
    return {.image = color.handle,
            .view = color.view,
            .format = color.info.format,
            .extent = desc_.extent,
            .layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
            .last_stages = copy_stages,
            .last_access = VK_ACCESS_2_TRANSFER_READ_BIT};
}

}  // namespace darkroom::render
