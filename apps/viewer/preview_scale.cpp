// SPDX-License-Identifier: MIT
#include "preview_scale.hpp"

#include <algorithm>

namespace app {

namespace {

/// Longer, and a hand no longer feels that it moves what it sees.
constexpr double slow = 1.0 / 15;
/// The step above is taken where it is expected to be this part of `slow`, so that two steps do not alternate.
constexpr double margin = 0.8;
/// A step that gains less is not worth its pixels.
constexpr double least_gain = 1.2;
constexpr double gain_of_pixels = 4;
/// Frames of the step before that are still under way, and the images that are made anew.
constexpr std::uint32_t not_counted = 2;
constexpr std::size_t counted = 3;
constexpr std::uint32_t frames_held = 240;

}  // namespace

void PreviewScale::change(std::uint32_t step) {
    step_ = step;
    skipped_ = 0;
    last_.clear();
}

void PreviewScale::add(double seconds) {
    if (held_ > 0) --held_;
    if (skipped_ < not_counted) {
        ++skipped_;
        return;
    }
    last_.push_back(seconds);
    const bool is_too_slow = last_.size() > 1 && std::ranges::min(last_) > gain_of_pixels * slow;
    if (last_.size() < counted && !is_too_slow) return;
    std::deque<double> sorted = last_;
    std::ranges::sort(sorted);
    const double median = sorted[sorted.size() / 2];
    if (last_.size() == counted) last_.pop_front();
    if (before_[step_] > 0) {
        const double gain = before_[step_] / median;
        before_[step_] = 0;
        gains_[step_] = std::clamp(gain, least_gain, gain_of_pixels);
        if (gain < least_gain) {
            held_ = frames_held;
            return change(came_from_);
        }
    }
    const double expected = median * (gains_[step_] > 0 ? gains_[step_] : gain_of_pixels);
    if (step_ > 0 && expected < margin * slow) return change(step_ - 1);
    if (median <= slow || step_ == most_steps || held_ > 0) return;
    // Where a half would be too slow, too, nobody has to wait until it was tried.
    const std::uint32_t next = median > gain_of_pixels * slow ? most_steps : step_ + 1;
    before_[next] = median;
    came_from_ = step_;
    change(next);
}

}  // namespace app
