// SPDX-License-Identifier: MIT
// How much of a frame is made anew: of a picture that a hand moves fewer pixels, of one that stands nothing.
#include <cmath>

#include "gpu/device/context.hpp"
#include "programs/darkroom/run/jitter.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;

namespace {

/// A picture that has not changed for so long is drawn whole.
constexpr std::chrono::milliseconds to_rest{300};

}  // namespace

// What is measured, watched or stored is the whole picture.
bool Viewer::is_looked_into() const {
    if (!wanted_.pictures.empty() || !wanted_.window.empty() || !wanted_.frame.empty()) return true;
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr) return false;
    const auto& look = views_[static_cast<std::size_t>(Side::Look)];
    return panels->pixel() || (look && panels->watched(look->composer().current_plan()) != nullptr);
}

// What a hand moves may be drawn smaller; what time alone moves has all pixels, or what a frame time leaves of them.
void Viewer::choose_scale() {
    const std::chrono::duration<double> still = last_turn_ - moved_at_;
    const bool is_over = still > to_rest + std::chrono::duration<double>(has_rested_ ? 0 : passed_);
    const bool is_running = is_time_running();
    if (is_led_ || developed_version_ != document_->version() || (!is_running && source_->is_another(moment()))) {
        moves_ = has_rested_ && is_over ? 1 : moves_ + 1;
        moved_at_ = last_turn_;
    } else if (is_over) {
        moves_ = 0;
    }
    // A single step, such as a switch, is shown as it is where nothing else is drawn before the next.
    const bool is_moving = moves_ > (is_running ? 0U : 1U) || (job_.frame_time && gathers() && is_running);
    const bool is_reduced = is_moving && !job_.is_full_size && !is_fixed() && !is_looked_into();
    scale_ = is_reduced ? pace_.scale() : 1;
}

Result<> Viewer::begin_timing(const darkroom::window::PresentFrame& frame) {
    if (timers_.context == nullptr) {
        DARKROOM_TRY_VALUE(timers_, darkroom::gpu::Timers::create(device_->context(), frames_in_flight, 2));
    }
    // A device without timestamps: from one frame to the next.
    double milliseconds = passed_ * 1000;
    const bool has_none = timers_.pools.empty();
    const double timed = std::exchange(timed_[frame.slot], 0);
    const bool is_known =
        has_none ? has_developed_ && !has_rested_ : timed > 0 && timers_.read(frame.slot, 2, {&milliseconds, 1}) == 1;
    if (is_known && (has_none ? scale_ : timed) == pace_.scale()) pace_.add(milliseconds / 1000);
    timers_.begin(frame.commands, frame.slot);
    timers_.mark(frame.commands, frame.slot, 0);
    return {};
}

void Viewer::end_timing(const darkroom::window::PresentFrame& frame) {
    timers_.mark(frame.commands, frame.slot, 1);
    if (has_developed_) timed_[frame.slot] = scale_;
}

// One picture alone is none of several, and what is compared with others stands still beside them.
bool Viewer::gathers() const {
    const bool is_one = is_fixed() && *job_.frames_to_show == 1;
    return scene_ != nullptr && is_post_on_ && !is_one && !screen_.is_comparing() && gathers_frames(document_->look());
}

darkroom::render::FrameJitter Viewer::jitter() const {
    if (!gathers()) return {};
    darkroom::render::FrameJitter out{.now = darkroom::Composer::jitter(frame_index_, static_cast<float>(1 / scale_))};
    out.before = last_jitter_.value_or(out.now);
    return out;
}

bool Viewer::has_come_to_rest() const { return scale_ < 1 && Clock::now() - moved_at_ > to_rest; }

bool Viewer::is_picture_kept() const {
    return !is_fixed() && !is_time_running() && !is_looked_into() && !is_cut_ && source_->is_kept() &&
           !interface_->is_new() && developed_version_ == document_->version();
}

}  // namespace app
