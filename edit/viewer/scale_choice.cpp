// SPDX-License-Identifier: MIT
#include "scale_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/assert.hpp"

namespace app {

namespace {

/// A finer step is taken where it is expected to need this part of what it may, so that two steps do not alternate.
constexpr double share_used = 0.8;
/// A step of four times fewer pixels that gains less is not worth them; smaller steps gain less.
constexpr double min_gain = 1.2, pixels_of_least_gain = 4;
/// So many times too long, and the next picture must not wait for a third like it.
constexpr double far_too_long = 4;
/// More than that no finer step is expected to take: it was left while something else had the machine.
constexpr double max_gain = 4;
/// Pictures of the step before that are still under way, and the images that are made anew.
constexpr std::uint32_t not_counted = 2;
constexpr std::size_t counted = 3;
constexpr std::uint32_t first_hold = 240, longest_hold = 1U << 20;

double least_gain_of(double fewer_pixels) {
    return 1 + (min_gain - 1) * std::min(1.0, (fewer_pixels - 1) / (pixels_of_least_gain - 1));
}

}  // namespace

ScaleChoice::ScaleChoice(std::vector<double> scales, double most)
    : scales_(std::move(scales)), most_(most), hold_(first_hold) {
    DARKROOM_ASSERT(!scales_.empty() && most > 0);
}

double ScaleChoice::fewer(std::size_t step, std::size_t coarser) const {
    const double sides = scales_[step] / scales_[coarser];
    return sides * sides;
}

void ScaleChoice::change(std::size_t step) {
    step_ = step;
    skipped_ = 0;
    last_.clear();
}

void ScaleChoice::add(double seconds) {
    if (held_ > 0) --held_;
    if (skipped_ < not_counted) {
        ++skipped_;
        return;
    }
    last_.push_back(seconds);
    const bool is_far = last_.size() > 1 && std::ranges::min(last_) > far_too_long * most_;
    if (last_.size() < counted && !is_far) return;
    std::deque<double> sorted = last_;
    std::ranges::sort(sorted);
    const double median = sorted[sorted.size() / 2];
    if (last_.size() == counted) last_.pop_front();
    if (before_ > 0) {
        const double gain = std::exchange(before_, 0) / std::max(median, 1e-9);
        const double pixels = fewer(came_from_, step_);
        if (gain < least_gain_of(pixels)) {
            held_ = hold_;
            hold_ = std::min(2 * hold_, longest_hold);
            return change(came_from_);
        }
        hold_ = first_hold;
        power_ = std::log(gain) / std::log(pixels);
    }
    if (step_ > 0) {
        const double longer = std::min(std::pow(fewer(step_ - 1, step_), power_), max_gain);
        if (median * longer < share_used * most_) return change(step_ - 1);
    }
    if (median <= most_ || step_ + 1 == scales_.size() || held_ > 0) return;
    // Where the next step would be too slow, too, nobody has to wait until it was tried.
    std::size_t next = step_ + 1;
    while (next + 1 < scales_.size() && median > most_ * fewer(step_, next)) ++next;
    before_ = median;
    came_from_ = step_;
    change(next);
}

}  // namespace app
