// SPDX-License-Identifier: MIT
// The commands of a frame: the source, the looks that are seen, the interface over them.
#include <fmt/format.h>

#include <algorithm>

#include "programs/darkroom/run/jitter.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;
using darkroom::window::PresentFrame;

namespace {

VkExtent2D min_of(VkExtent2D a, VkExtent2D b) { return {std::min(a.width, b.width), std::min(a.height, b.height)}; }

}  // namespace

std::array<bool, side_count> Viewer::shown_sides() const {
    std::array<bool, side_count> out{};
    out[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)] = true;
    if (screen_.is_comparing())
        for (const Side side : {screen_.left(), screen_.right()})
            if (side != Side::Other || !other_picture_) out[static_cast<std::size_t>(side)] = true;
    return out;
}

// What the frame shows is made in the same commands, before it.
Result<> Viewer::prepare(const PresentFrame& frame, VkExtent2D extent) {
    DARKROOM_TRY_VALUE(LookView* const look, view(Side::Look));
    const bool is_first = look->most().width == 0;
    // Every side asks for the room that is wanted, and frames are as large as all that are shown can take by now.
    const VkExtent2D wanted = extent;
    const std::array<bool, side_count> is_shown = shown_sides();
    for (std::size_t side = 0; side < side_count; ++side) {
        if (!is_shown[side] || !views_[side] || views_[side]->most().width == 0) continue;
        settle(fmt::format("fit {}", side),
               views_[side]->fit(*source_, wanted, interface_->format(), store_.wants_picture()));
        extent = min_of(extent, views_[side]->most());
    }
    full_extent_ = extent;
    const VkExtent2D drawn = scaled(full_extent_, scale_.scale());
    made_extent_ = job_.frame_time ? full_extent_ : drawn;
    const LiveMoment now = moment();
    bool must_wait = source_->must_wait(now, drawn) || interface_->must_wait(full_extent_, made_extent_);
    for (const auto& any : views_) must_wait = must_wait || (any && any->must_wait(made_extent_));
    if (EditPanels* const panels = screen_.panels(); panels != nullptr && !is_first)
        must_wait = must_wait ||
                    look->must_wait_to_watch(panels->watched(look->composer().current_plan()), panels->watched_level());
    if (must_wait) DARKROOM_TRY(presenter_->wait());
    if (!is_first) DARKROOM_TRY(watch());
    DARKROOM_TRY(source_->prepare(now, drawn));
    last_orbit_ = scene_ != nullptr ? std::optional(now.orbit) : std::nullopt;
    last_jitter_ = now.jitter.now;
    if (is_first) DARKROOM_TRY(look->fit(*source_, made_extent_, interface_->format()));
    return record(frame);
}

Result<> Viewer::record(const PresentFrame& frame) {
    DARKROOM_TRY(source_->record(frame.commands));
    if (other_picture_) other_picture_->record(*device_, frame.commands);
    DARKROOM_TRY_VALUE(LookView* const look, view(Side::Look));
    for (const auto& any : views_)
        if (any) DARKROOM_TRY(any->resize(made_extent_));
    if (const std::optional<darkroom::ImageRef> display = source_->display_picture()) {
        look->copy(frame.commands, *display);
        return {};
    }
    darkroom::Frame input = source_->frame();
    if (scene_ != nullptr) {
        input.time = time_;
        input.delta_time = delta_time_;
        input.frame_index = frame_index_;
        input.camera.is_cut = is_cut_;
    }
    const bool is_kept = is_picture_kept();
    if (interface_->is_given()) {
        DARKROOM_TRY_VALUE(
            input.ui, interface_->record(frame.commands, frame.slot, full_extent_, made_extent_, window_->scale()));
    }
    const std::array<bool, side_count> is_shown = shown_sides();
    for (std::size_t side = 0; side < side_count; ++side)
        if (is_shown[side] && !(is_kept && views_[side] && views_[side]->is_current()))
            DARKROOM_TRY(record_look(frame.commands, static_cast<Side>(side), input));
    is_cut_ = false;
    developed_version_ = document_->version();
    return inspect(frame.commands, input);
}

Result<> Viewer::record_look(VkCommandBuffer commands, Side side, const darkroom::Frame& frame) {
    DARKROOM_TRY_VALUE(LookView* const found, view(side));
    LookView& of = *found;
    if (of.most().width == 0) DARKROOM_TRY(of.fit(*source_, full_extent_, interface_->format()));
    // Only under a frame time frames have another size than their picture.
    const VkExtent2D extent = job_.frame_time ? made_extent_ : frame.color.used_region().extent;
    DARKROOM_TRY(of.resize(extent));
    if (is_fixed()) of.composer().wait_for_kernels();
    has_developed_ = true;
    // A plan that does not fit yet is on its way, that of a frame which brings other images from here on: the picture
    // stays what it was.
    const Result<> recorded = of.record(commands, frame);
    if (!recorded && !of.is_coming())
        settle(fmt::format("fit {}", static_cast<int>(side)),
               of.fit(*source_, full_extent_, interface_->format(), store_.wants_picture()));
    if (recorded || !of.is_coming()) settle(fmt::format("frame {}", static_cast<int>(side)), recorded);
    return {};
}

}  // namespace app
