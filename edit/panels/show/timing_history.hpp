// SPDX-License-Identifier: MIT
#pragma once
// GPU times of the last frames, pass by pass, and what recording them cost: numbers only; panels/show/timings.hpp draws
// them. Bounded: it forgets the oldest frame, and names that no frame has any more.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <deque>
#include <string>
#include <vector>

namespace darkroom::panels {

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

}  // namespace darkroom::panels
