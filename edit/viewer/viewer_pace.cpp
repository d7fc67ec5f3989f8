// SPDX-License-Identifier: MIT
// When a frame is drawn, and how much of it is made anew: of a picture that a hand moves fewer pixels, of one that
// stands nothing. A frame is drawn while time runs, while its user does something, and when something else has changed.
#include <cmath>

#include "gpu/device/context.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "programs/darkroom/run/jitter.hpp"
#include "viewer_state.hpp"

namespace app {

namespace {

using std::chrono::milliseconds;

/// What moves behind a hand, tooltips among it, comes to rest within this time.
constexpr milliseconds after_input{700};
/// Between looks at what is on its way.
constexpr milliseconds between_frames{100};
/// So long nobody looks; who talks to it waits as long for an answer.
constexpr double nap = 0.03;
/// Whatever changed, the frame after shows, too, what follows from it.
constexpr std::uint32_t frames_after_change = 3;

}  // namespace

bool Viewer::is_time_running() const {
    return !is_paused_ && (scene_ != nullptr || source_->frames() > 0 || interface_->has_controllers());
}

bool Viewer::is_coming() const {
    if (source_->is_coming() || interface_->is_new()) return true;
    const std::array<bool, side_count> is_shown = shown_sides();
    for (std::size_t side = 0; side < side_count; ++side)
        if (is_shown[side] && views_[side] && views_[side]->is_coming()) return true;
    return false;
}

bool Viewer::is_due() {
    if (is_fixed()) return true;
    const Clock::time_point now = Clock::now();
    if (window_->take_news() || darkroom::panels::has_input_waiting()) busy_until_ = now + after_input;
    const bool is_changed = screen_.take_change() || drawn_version_ != document_->version();
    drawn_version_ = document_->version();
    if (is_changed) frames_due_ = frames_after_change;
    const bool is_wanted = store_.is_wanted() || places_;
    is_echo_ = false;
    if (is_time_running() || camera_->is_falling() || now < busy_until_ || is_wanted || frames_due_ > 0) {
        if (frames_due_ > 0) --frames_due_;
        return true;
    }
    if (has_thumbnails_ && thumbnails_ && (thumbnails_frame_ || thumbnails_->has_new())) return true;
    const bool is_old = now - last_turn_ >= between_frames;
    if ((is_old && (is_coming() || screen_.is_over())) || scale_.has_come_to_rest()) return true;
    // What a frame measured is shown by another, which measures nothing.
    is_echo_ = std::exchange(has_measured_, false);
    return is_echo_;
}

void Viewer::rest() { is_resting_ && !is_fixed() ? window_->wait(nap) : window_->poll(); }

double Viewer::frames_a_second() {
    const Clock::time_point now = Clock::now();
    shown_at_.push_back(now);
    while (shown_at_.size() > 1 && now - shown_at_.front() > std::chrono::seconds(2)) shown_at_.pop_front();
    const double seconds = std::chrono::duration<double>(now - shown_at_.front()).count();
    if (!is_time_running() && now >= busy_until_) return 0;
    return seconds > 0 ? static_cast<double>(shown_at_.size() - 1) / seconds : 0;
}

// What is measured, watched or stored is the whole picture.
bool Viewer::is_looked_into() const {
    if (store_.is_wanted()) return true;
    const EditPanels* const panels = screen_.panels();
    if (panels == nullptr) return false;
    const auto& look = views_[static_cast<std::size_t>(Side::Look)];
    return panels->pixel() || (look && panels->watched(look->composer().current_plan()) != nullptr);
}

DrawScale::Turn Viewer::draw_turn() const {
    const bool is_running = is_time_running();
    return {.now = last_turn_,
            .passed = passed_,
            .has_rested = has_rested_,
            .is_moved =
                is_led_ || developed_version_ != document_->version() || (!is_running && source_->is_another(moment())),
            .is_running = is_running,
            .gathers = gathers(),
            .may_reduce = !job_.is_full_size && !is_fixed() && !is_looked_into()};
}

// One picture alone is none of several, and what is compared with others stands still beside them.
bool Viewer::gathers() const {
    const bool is_one = is_fixed() && *job_.frames_to_show == 1;
    return scene_ != nullptr && is_post_on_ && !is_one && !screen_.is_comparing() && gathers_frames(document_->look());
}

darkroom::render::FrameJitter Viewer::jitter() const {
    if (!gathers()) return {};
    darkroom::render::FrameJitter out{
        .now = darkroom::Composer::jitter(frame_index_, static_cast<float>(1 / scale_.scale()))};
    out.before = last_jitter_.value_or(out.now);
    return out;
}

bool Viewer::is_picture_kept() const {
    return !is_fixed() && !is_time_running() && !is_looked_into() && !is_cut_ && source_->is_kept() &&
           !interface_->is_new() && developed_version_ == document_->version();
}

}  // namespace app
