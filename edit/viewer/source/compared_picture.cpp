// SPDX-License-Identifier: MIT
#include "compared_picture.hpp"

#include "gpu/resource/barriers.hpp"

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
    const VkImageMemoryBarrier2 change = darkroom::gpu::image_barrier(
        image_.image, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, image_.layout},
        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    darkroom::gpu::record_barriers(context.vk, commands, {&change, 1});
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
