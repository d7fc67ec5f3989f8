// SPDX-License-Identifier: MIT
#include "compared_picture.hpp"

#include "gpu/device/context.hpp"

namespace app {

using darkroom::Result;

Result<ComparedPicture> ComparedPicture::create(darkroom::Device& device, darkroom::ComparablePicture picture) {
    ComparedPicture out;
    out.picture_ = std::move(picture);
    const darkroom::Picture& read = out.picture_.picture;
    const darkroom::DevelopInput input{.extent = {read.width, read.height}, .color = read.pixels};
    DARKROOM_TRY(out.upload_.prepare(device.context(), input, darkroom::layers_of(input)));
    return out;
}

void ComparedPicture::record(const darkroom::Device& device, VkCommandBuffer commands) {
    if (image_.is_given()) return;
    const darkroom::gpu::Context& context = device.context();
    upload_.record(context, commands);
    image_ = upload_.frame({}).color;
    const VkImageMemoryBarrier2 change{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                       .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                       .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                       .dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                       .oldLayout = image_.layout,
                                       .newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image_.image,
                                       .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &change};
    context.vk.CmdPipelineBarrier2(commands, &dependency);
    image_.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    picture_.picture = {};
}

darkroom::window::PaneView ComparedPicture::pane() const {
    using darkroom::window::PaneTransfer;
    const bool is_light = picture_.encoding != darkroom::PictureEncoding::Display;
    return {.image = image_, .transfer = is_light ? PaneTransfer::SceneLinear : PaneTransfer::Encoded};
}

bool is_picture_file(const std::filesystem::path& file) { return file.extension() != ".toml"; }

}  // namespace app
