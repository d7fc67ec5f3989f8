// SPDX-License-Identifier: MIT
#include "draw_scale.hpp"

#include <utility>
#include <vector>

#include "gpu/device/context.hpp"

namespace app {

using darkroom::Result;

namespace {

/// Seconds. Longer, and a hand no longer feels that it moves what it sees.
constexpr double longest_preview = 1.0 / 15;
/// A picture that has not changed for so long is drawn whole.
constexpr std::chrono::milliseconds to_rest{300};

// Of a scene to those of its picture a third is what upscalers are made for, and a step between gains a third.
std::vector<double> steps(bool has_frame_time) {
    if (has_frame_time) return {1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 1.0 / 3};
    return {1, 0.5, 0.25};
}

}  // namespace

DrawScale::DrawScale(std::optional<double> frame_time)
    : has_frame_time_(frame_time.has_value()), choice_(steps(has_frame_time_), frame_time.value_or(longest_preview)) {}

void DrawScale::choose(const Turn& turn) {
    const std::chrono::duration<double> still = turn.now - moved_at_;
    const bool is_over = still > to_rest + std::chrono::duration<double>(turn.has_rested ? 0 : turn.passed);
    if (turn.is_moved) {
        moves_ = turn.has_rested && is_over ? 1 : moves_ + 1;
        moved_at_ = turn.now;
    } else if (is_over) {
        moves_ = 0;
    }
    // A single step, such as a switch, is shown as it is where nothing else is drawn before the next.
    const bool is_moving = moves_ > (turn.is_running ? 0U : 1U) || (has_frame_time_ && turn.gathers && turn.is_running);
    scale_ = is_moving && turn.may_reduce ? choice_.scale() : 1;
}

bool DrawScale::has_come_to_rest() const { return scale_ < 1 && Clock::now() - moved_at_ > to_rest; }

Result<> DrawScale::begin_timing(const darkroom::Device& device, const darkroom::window::PresentFrame& frame,
                                 const Turn& turn, bool has_developed) {
    if (timers_.context == nullptr) {
        DARKROOM_TRY_VALUE(timers_, darkroom::gpu::Timers::create(device.context(), frames_in_flight, 2));
    }
    // A device without timestamps: from one frame to the next.
    double milliseconds = turn.passed * 1000;
    const bool has_none = timers_.pools.empty();
    const double timed = std::exchange(timed_[frame.slot], 0);
    const bool is_known = has_none ? has_developed && !turn.has_rested
                                   : timed > 0 && timers_.read(frame.slot, 2, {&milliseconds, 1}) == 1;
    if (is_known && (has_none ? scale_ : timed) == choice_.scale()) choice_.add(milliseconds / 1000);
    timers_.begin(frame.commands, frame.slot);
    timers_.mark(frame.commands, frame.slot, 0);
    return {};
}

void DrawScale::end_timing(const darkroom::window::PresentFrame& frame, bool has_developed) {
    timers_.mark(frame.commands, frame.slot, 1);
    if (has_developed) timed_[frame.slot] = scale_;
}

void DrawScale::forget_device() {
    timers_ = {};
    timed_ = {};
}

}  // namespace app
