// SPDX-License-Identifier: MIT
// When a frame is drawn: while time runs, while its user does something, and when something else has changed. Else the
// window keeps the picture that it has.
#include "panels/widgets/imgui_versions.hpp"
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
    const bool is_wanted = !wanted_.pictures.empty() || !wanted_.window.empty() || !wanted_.frame.empty() || places_;
    is_echo_ = false;
    if (is_time_running() || camera_->is_falling() || now < busy_until_ || is_wanted || frames_due_ > 0) {
        if (frames_due_ > 0) --frames_due_;
        return true;
    }
    if (has_thumbnails_ && thumbnails_ && (thumbnails_frame_ || thumbnails_->has_new())) return true;
    const bool is_old = now - last_turn_ >= between_frames;
    if ((is_old && (is_coming() || screen_.is_over())) || has_come_to_rest()) return true;
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

}  // namespace app
