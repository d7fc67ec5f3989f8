// SPDX-License-Identifier: MIT
#include "panels/show/timing_history.hpp"

#include <algorithm>
#include <cmath>

namespace darkroom::panels {

namespace {

/// Of an even number the upper one of the two in the middle.
TimingHistory::Statistics statistics(std::vector<float> values) {
    if (values.empty()) return {};
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return {.median = *middle, .worst = *std::ranges::max_element(values)};
}

float number(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0f; }

}  // namespace

void TimingHistory::add(const RecordingTimes& times, double record_microseconds) {
    if (times.passes.empty()) return;
    if (!frames_.empty() && frames_.back().frame_index == times.frame_index) return;
    Frame frame{.frame_index = times.frame_index, .record_microseconds = number(record_microseconds)};
    for (const PassTime& pass : times.passes) {
        const float milliseconds = number(pass.milliseconds);
        frame.milliseconds += milliseconds;
        if (frame.passes.size() < max_passes)
            frame.passes.push_back({.name = index_of(pass.name), .milliseconds = milliseconds});
        else
            frame.passes.back().milliseconds += milliseconds;
    }
    frames_.push_back(std::move(frame));
    if (frames_.size() > max_frames) frames_.pop_front();
    if (names_.size() > 2 * max_passes) drop_unused_names();
}

std::uint32_t TimingHistory::index_of(std::string_view name) {
    const auto index = std::ranges::find(names_, name) - names_.begin();
    if (index == std::ssize(names_)) names_.emplace_back(name);
    return static_cast<std::uint32_t>(index);
}

void TimingHistory::drop_unused_names() {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> index(names_.size(), unused);
    std::vector<std::string> kept;
    for (Frame& frame : frames_)
        for (Pass& pass : frame.passes) {
            if (index[pass.name] == unused) {
                index[pass.name] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(std::move(names_[pass.name]));
            }
            pass.name = index[pass.name];
        }
    names_ = std::move(kept);
}

TimingHistory::Statistics TimingHistory::of_frames() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.milliseconds);
    return statistics(std::move(values));
}

float TimingHistory::max_shown() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.milliseconds);
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return std::min(1.5f * values[(values.size() - 1) * 9 / 10], 1.05f * values.back());
}

TimingHistory::Statistics TimingHistory::of_recording() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.record_microseconds);
    return statistics(std::move(values));
}

TimingHistory::Statistics TimingHistory::of_pass(std::uint32_t name) const {
    std::vector<float> values;
    for (const Frame& frame : frames_)
        for (const Pass& pass : frame.passes)
            if (pass.name == name) values.push_back(pass.milliseconds);
    return statistics(std::move(values));
}

}  // namespace darkroom::panels
