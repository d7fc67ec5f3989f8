// SPDX-License-Identifier: MIT
#pragma once
// GPU times as the present window shows them: the last frame as one bar of its passes, the last frames as a history, a
// line for each pass, and what recording costs on the CPU.

#include <cstdint>

#include "panels/show/timing_history.hpp"

namespace darkroom::panels {

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
