// SPDX-License-Identifier: MIT
#include "inspection.hpp"

#include <algorithm>

#include "gpu/device/context.hpp"

namespace app {

using darkroom::Result;

namespace {

/// Of what scopes measure.
constexpr VkExtent2D scope_extent{480, 270};
constexpr VkFormat scope_format = VK_FORMAT_R8G8B8A8_UNORM;

}  // namespace

Result<> FrameInspection::record_pixel(darkroom::Device& device, VkCommandBuffer commands, std::uint64_t number,
                                       LookView& look, const darkroom::Frame& frame, std::optional<VkOffset2D> pixel) {
    if (!pixel) {
        // It goes when nothing of it is under way.
        if (pending_.empty()) inspector_.reset();
        pixel_.reset();
        return {};
    }
    if (!inspector_) inspector_ = std::make_unique<darkroom::Inspector>(device);
    darkroom::CompileDesc compiled = look.compile_desc();
    compiled.watches.clear();
    DARKROOM_TRY(inspector_->update(look.composer(), compiled, frame));
    const Result<std::uint64_t> recording = inspector_->record(commands, look.composer(), frame, {&*pixel, 1});
    if (recording) pending_.push_back({.frame = number, .recording = *recording});
    return {};
}

Result<> FrameInspection::record_scopes(darkroom::Device& device, const darkroom::window::PresentFrame& frame,
                                        const LookView& look, bool is_another) {
    // Of a picture that stands they stand, too.
    if (scope_frame_ || (has_scopes_ && !is_another)) return {};
    darkroom::gpu::Context& context = device.context();
    const darkroom::ImageRef picture = look.picture();
    if (!picture.is_given()) return {};
    const VkExtent2D extent{std::min(scope_extent.width, picture.extent.width),
                            std::min(scope_extent.height, picture.extent.height)};
    // Light is encoded by the format that it is copied into.
    const bool is_light = look.transfer() == darkroom::window::PaneTransfer::SceneLinear;
    const VkFormat format = is_light ? VK_FORMAT_R8G8B8A8_SRGB : scope_format;
    if (scope_image_.info.extent.width != extent.width || scope_image_.info.extent.height != extent.height ||
        scope_image_.info.format != format) {
        DARKROOM_TRY_VALUE(scope_image_,
                           darkroom::gpu::Image::create(
                               context, {.name = "scopes",
                                         .format = format,
                                         .extent = {extent.width, extent.height, 1},
                                         .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    }
    darkroom::ImageRef small{.image = scope_image_.handle,
                             .view = scope_image_.view,
                             .format = scope_format,
                             .extent = extent,
                             .layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    look.copy_to(frame.commands, scope_image_);
    DARKROOM_TRY_VALUE(scope_read_, darkroom::Readback::create(context, small));
    scope_read_->record(frame.commands);
    scope_frame_ = frame.number;
    has_scopes_ = true;
    return {};
}

bool FrameInspection::finish(const darkroom::window::Presenter& presenter,
                             const std::function<void(const darkroom::panels::ScopePicture&)>& measure) {
    bool is_new = false;
    while (!pending_.empty() && presenter.is_finished(pending_.front().frame)) {
        if (inspector_)
            if (auto result = inspector_->result(pending_.front().recording)) {
                pixel_ = std::move(result);
                is_new = true;
            }
        pending_.pop_front();
    }
    if (!scope_frame_ || !presenter.is_finished(*scope_frame_)) return is_new;
    const std::vector<std::uint8_t> bytes = scope_read_->bytes();
    const VkExtent2D extent = scope_read_->extent();
    measure({.width = extent.width, .height = extent.height, .bytes = bytes});
    scope_read_.reset();
    scope_frame_.reset();
    return true;
}

}  // namespace app
