// SPDX-License-Identifier: MIT
#pragma once
// How coarse a picture is while something in it moves: whole, a half or a quarter of its width and height, by the time
// that frames have taken. It knows no clock and no picture.

#include <array>
#include <cstdint>
#include <deque>

namespace app {

class PreviewScale {
  public:
    /// Pictures that move are drawn with so many times fewer pixels each way.
    [[nodiscard]] std::uint32_t divisor() const { return 1U << step_; }
    /// A frame of that divisor took so long, beginning to beginning, with another one right behind it. Seconds.
    void add(double seconds);

  private:
    static constexpr std::uint32_t most_steps = 2;
    void change(std::uint32_t step);

    std::uint32_t step_ = 0, skipped_ = 0, came_from_ = 0;
    std::deque<double> last_;                      ///< frames of this step
    std::array<double, most_steps + 1> before_{};  ///< what the step took that was left for it; 0: it was not
    std::array<double, most_steps + 1> gains_{};   ///< how many times faster a step was than the one above; 0: unknown
    std::uint32_t held_ = 0;                       ///< frames for which no coarser step is tried again
};

}  // namespace app
