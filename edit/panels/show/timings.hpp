// SPDX-License-Identifier: MIT
#pragma once
// GPU times as the present window shows them: the last frame as one bar of its passes, the last frames as a history, a
// line for each pass, and what recording costs on the CPU.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <deque>
#include <string>
#include <vector>

namespace darkroom::panels {

// GPU times of the last frames, pass by pass, and what recording them cost: numbers only; panels/show/timings.hpp draws
// them. Bounded: it forgets the oldest frame, and names that no frame has any more.

class TimingHistory {
  public:
    static constexpr std::size_t max_frames = 240;
    static constexpr std::size_t max_passes = 256;  ///< of a frame; what is beyond is added to the last

    struct Pass {
        std::uint32_t name = 0;  ///< index for name()
        float milliseconds = 0;
    };
    struct Frame {
        std::uint64_t frame_index = 0;
        std::vector<Pass> passes;  ///< in their order
        float milliseconds = 0;    ///< of all
        float record_microseconds = 0;
    };
    struct Statistics {
        float median = 0, worst = 0;
    };

    /// Composer::times() and Composer::record_microseconds(), as often as there is a frame: a recording that is there
    /// already, or has no times, is not taken. Times that are no numbers count as 0.
    void add(const RecordingTimes& times, double record_microseconds);
    void clear() { *this = {}; }

    /// The oldest first.
    [[nodiscard]] const std::deque<Frame>& frames() const { return frames_; }
    [[nodiscard]] const std::string& name(std::uint32_t index) const { return names_[index]; }
    [[nodiscard]] std::size_t name_count() const { return names_.size(); }

    /// Over the frames that are kept. Of a pass: over those that have it.
    [[nodiscard]] Statistics of_frames() const;
    [[nodiscard]] Statistics of_recording() const;  ///< microseconds
    [[nodiscard]] Statistics of_pass(std::uint32_t name) const;
    /// What a plot of the frames should reach up to, in milliseconds: nine of ten frames lie below two thirds of it,
    /// and a few that took far longer (a driver that compiled) are cut off.
    [[nodiscard]] float max_shown() const;

  private:
    std::uint32_t index_of(std::string_view name);
    void drop_unused_names();

    std::deque<Frame> frames_;
    std::vector<std::string> names_;
};

struct Plot;

class TimingsPanel {
  public:
    /// Fills the rest of the window. A pass under the mouse stands out everywhere.
    void draw(const TimingHistory& history);

  private:
    void draw_bar(const TimingHistory& history);
    void draw_history(const TimingHistory& history, float height);
    /// Of the frame of this number, up to `most` milliseconds.
    void draw_column(const Plot& plot, const TimingHistory::Frame& frame, float number, float most) const;
    /// `place`: milliseconds from the bottom.
    void history_tooltip(const TimingHistory& history, const TimingHistory::Frame& frame, float place);
    void draw_table(const TimingHistory& history);
    void draw_name(const TimingHistory& history, const TimingHistory::Pass& pass, float whole);
    [[nodiscard]] std::uint32_t color_of(std::uint32_t name) const;

    static constexpr std::uint32_t none = ~0u;
    std::uint32_t pointed_ = none, next_pointed_ = none;  ///< names: of the last frame, of the one being drawn
};

}  // namespace darkroom::panels
