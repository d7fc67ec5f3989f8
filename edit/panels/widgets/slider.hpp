// SPDX-License-Identifier: MIT
#pragma once
// Sliders for numbers of any interval. ImGui's own hide what they show under their knob, and clamp what is typed.

#include <darkroom/param.hpp>

namespace darkroom::panels {

/// To four significant digits: what a hand on a mouse means.
[[nodiscard]] double four_digits(double number);

/// How values lie on a slider, from 0 to 1. In equal ratios where the row says so; and nearly so, from about a tenth of
/// the default on, where the interval is so wide that its uses would lie in the first pixels: with the knee k,
///     position ~ sign(v) ln(1 + |v| / k)
/// which goes through 0 and has both signs. Else evenly, and so do whole numbers of at most a hundred.
class SliderScale {
  public:
    SliderScale(const Range& range, double usual, bool is_whole = false);
    [[nodiscard]] double position(double value) const;
    [[nodiscard]] double value(double position) const;

  private:
    [[nodiscard]] double spread(double value) const;
    Range range_;
    bool is_log_ = false;
    double knee_ = 0;  ///< 0: none
};

/// What happened to a slider in this frame.
struct SliderEdit {
    bool is_changed = false;
    bool is_begun = false;
};
/// A slider of the present item width over the row's interval: `number` is set to four significant digits, or to a
/// whole number. Shift drags slowly. Ctrl and a click type a number, which is handed on as it is typed, also where the
/// interval does not hold it. `usual` is the default, which a tick marks.
[[nodiscard]] SliderEdit draw_slider(const char* id, const ParamInfo& row, double usual, double& number);

}  // namespace darkroom::panels
