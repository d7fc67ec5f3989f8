// SPDX-License-Identifier: MIT
#include "playback.hpp"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// Sums of steps of 1/24 s reach a frame's beginning but for their rounding.
constexpr double rounding = 1e-6;

}  // namespace

std::size_t Playback::number() const {
    if (frames_ == 0) return 0;
    return std::min(static_cast<std::size_t>(std::max(std::floor(at_ + rounding), 0.0)), frames_ - 1);
}

bool Playback::advance(double seconds) {
    if (frames_ == 0) return true;
    at_ += seconds * rate_;
    const auto first = static_cast<double>(first_), end = static_cast<double>(last_ + 1);
    if (at_ + rounding < end) return true;
    if (!is_looping_) {
        at_ = static_cast<double>(last_);
        return false;
    }
    at_ = first + std::fmod(at_ + rounding - first, end - first);
    return true;
}

void Playback::step(long frames) {
    if (frames_ == 0) return;
    const auto first = static_cast<long>(first_), count = static_cast<long>(last_) - first + 1;
    const long from_first = static_cast<long>(std::clamp(number(), first_, last_)) - first + frames;
    at_ = static_cast<double>(first + ((from_first % count) + count) % count);
}

void Playback::seek(std::size_t number) { at_ = static_cast<double>(std::min(number, frames_ > 0 ? frames_ - 1 : 0)); }

void Playback::begin_here() {
    first_ = number();
    last_ = std::max(last_, first_);
}

void Playback::end_here() {
    last_ = number();
    first_ = std::min(first_, last_);
}

void Playback::play_all() {
    first_ = 0;
    last_ = frames_ > 0 ? frames_ - 1 : 0;
}

void Playback::set_rate(double rate) {
    // What is shown stays.
    at_ = static_cast<double>(number());
    rate_ = std::clamp(rate, 1e-3, 1e3);
}

}  // namespace app
