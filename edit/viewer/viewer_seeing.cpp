// SPDX-License-Identifier: MIT
#include <algorithm>

#include "gpu/device/context.hpp"
#include "programs/darkroom/run/shipped.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;

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
    if (pixel && is_echo_) return {};
    LookView& look = *views_[static_cast<std::size_t>(Side::Look)];
    settle("pixel", inspection_.record_pixel(*device_, commands, frame_number_, look, frame, pixel));
    return {};
}

Result<> Viewer::read_scopes(const darkroom::window::PresentFrame& frame) {
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr || !panels->wants_scopes()) {
        inspection_.hide_scopes();
        return {};
    }
    if (is_echo_) return {};
    const LookView& look = *views_[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)];
    return inspection_.record_scopes(*device_, frame, look, has_developed_);
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
    const auto measure = [this](const darkroom::panels::ScopePicture& picture) {
        if (EditPanels* const panels = screen_.panels()) panels->measure(picture);
    };
    if (inspection_.finish(*presenter_, measure)) has_measured_ = true;
}

}  // namespace app
