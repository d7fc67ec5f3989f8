// SPDX-License-Identifier: MIT
#include <algorithm>

#include "gpu/device/context.hpp"
#include "programs/darkroom/run/shipped.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;

namespace {

/// Of what scopes measure.
constexpr VkExtent2D scope_extent{480, 270};
constexpr VkFormat scope_format = VK_FORMAT_R8G8B8A8_UNORM;

}  // namespace

/// No frame is unfinished where the image is another.
Result<> Viewer::watch() {
    LookView& look = *views_[static_cast<std::size_t>(Side::Look)];
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr) return look.watch(nullptr, 0);
    return look.watch(panels->watched(look.composer().current_plan()), panels->watched_level());
}

Result<> Viewer::inspect(VkCommandBuffer commands, const darkroom::Frame& frame) {
    const EditPanels* const panels = screen_.panels();
    const std::optional<VkOffset2D> pixel = panels != nullptr ? panels->pixel() : std::nullopt;
    if (!pixel) {
        // It goes when nothing of it is under way.
        if (inspected_.empty()) inspector_.reset();
        inspection_.reset();
        return {};
    }
    if (is_echo_) return {};
    LookView& look = *views_[static_cast<std::size_t>(Side::Look)];
    if (!inspector_) inspector_ = std::make_unique<darkroom::Inspector>(*device_);
    darkroom::CompileDesc compiled = look.compile_desc();
    compiled.watches.clear();
    if (Result<> done = inspector_->update(look.composer(), compiled, frame); !done) {
        settle("pixel", done);
        return {};
    }
    const Result<std::uint64_t> recording = inspector_->record(commands, look.composer(), frame, {&*pixel, 1});
    if (recording) inspected_.push_back({.frame = frame_number_, .recording = *recording});
    return {};
}

Result<> Viewer::read_scopes(const darkroom::window::PresentFrame& frame) {
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr || !panels->wants_scopes()) {
        has_scopes_ = false;
        return {};
    }
    // Of a picture that stands they stand, too.
    if (scope_frame_ || is_echo_ || (has_scopes_ && !has_developed_)) return {};
    darkroom::gpu::Context& context = device_->context();
    const LookView& look = *views_[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)];
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

// Begun when the menu opens, of the frame that is shown then, and left when it closes.
void Viewer::show_thumbnails(const darkroom::window::PresentFrame& frame) {
    EditPanels* const panels = screen_.panels();
    const bool is_wanted = panels != nullptr && panels->look().is_adding() && !source_->display_picture();
    if (!is_wanted) {
        if (thumbnails_) thumbnails_->stop();
        has_thumbnails_ = false;
        return;
    }
    if (!has_thumbnails_) {
        // Those of the last time may still be on the screen.
        if (thumbnails_)
            if (Result<> done = presenter_->wait(); !done) return settle("thumbnails", done);
        thumbnails_.reset();
        Result<std::unique_ptr<Thumbnails>> made = Thumbnails::create(
            *device_, source_->frame(),
            {.look = document_->look(), .other_looks = shipped_looks().size(), .read = look_reader()});
        settle("thumbnails", made ? Result<>() : failure(made.error()));
        has_thumbnails_ = true;
        if (!made) return;
        thumbnails_ = std::move(*made);
        thumbnails_->record_frame(frame.commands);
        thumbnails_frame_ = frame.number;
        return;
    }
    if (!thumbnails_) return;
    if (thumbnails_frame_ && presenter_->is_finished(*thumbnails_frame_)) {
        thumbnails_frame_.reset();
        settle("thumbnails", thumbnails_->begin());
    }
    if (const std::optional<darkroom::Error> error = thumbnails_->take_error()) settle("thumbnails", failure(*error));
    thumbnails_->record(frame.commands);
}

darkroom::panels::Thumbnail Viewer::thumbnail_of(const Thumbnails::Subject& subject) {
    if (!has_thumbnails_ || !thumbnails_) return {};
    Thumbnails::Shown shown = thumbnails_->of(subject);
    return {.texture = shown.pane != nullptr ? shown.pane->texture() : nullptr,
            .aspect = thumbnails_->aspect(),
            .error = std::move(shown.error)};
}

void Viewer::finish_seeing() {
    while (!inspected_.empty() && presenter_->is_finished(inspected_.front().frame)) {
        if (inspector_)
            if (auto result = inspector_->result(inspected_.front().recording)) {
                inspection_ = std::move(result);
                has_measured_ = true;
            }
        inspected_.pop_front();
    }
    if (!scope_frame_ || !presenter_->is_finished(*scope_frame_)) return;
    const std::vector<std::uint8_t> bytes = scope_read_->bytes();
    const VkExtent2D extent = scope_read_->extent();
    if (EditPanels* const panels = screen_.panels())
        panels->measure({.width = extent.width, .height = extent.height, .bytes = bytes});
    scope_read_.reset();
    scope_frame_.reset();
    has_measured_ = true;
}

}  // namespace app
