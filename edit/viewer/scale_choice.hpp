// SPDX-License-Identifier: MIT
#pragma once
// How large pictures are drawn so that each takes no longer than it may: one of a few scales, by the times that
// pictures have taken. It knows no clock and no picture, and comes to rest where their cost does.

#include <cstdint>
#include <deque>
#include <vector>

namespace app {

class ScaleChoice {
  public:
    /// `scales`: of the sides, the first is 1, each smaller than the one before. `most`: seconds.
    ScaleChoice(std::vector<double> scales, double most);

    [[nodiscard]] double scale() const { return scales_[step_]; }
    /// A picture of that scale took so long, with others of it before and behind. Seconds.
    void add(double seconds);

  private:
    void change(std::size_t step);
    /// How many times fewer pixels the second has.
    [[nodiscard]] double fewer(std::size_t step, std::size_t coarser) const;

    std::vector<double> scales_;
    double most_;
    std::size_t step_ = 0, came_from_ = 0;
    std::uint32_t skipped_ = 0;
    std::deque<double> last_;  ///< pictures of this step
    double before_ = 0;        ///< what the step took that was left for this one; 0: it was no finer one
    double power_ = 1;         ///< of the pixels, that times follow: seen where a finer step was left last
    std::uint32_t held_ = 0;   ///< pictures for which no coarser step is tried again
    std::uint32_t hold_;       ///< as many at the next time that one gains nothing
};

}  // namespace app
