// SPDX-License-Identifier: MIT
#pragma once
// Three numbers, of red, green and blue, as colourists hold them: their mean on a slider, and what each differs from it
// as a place on a disc, with red, green and blue 120 degrees apart as on a vectorscope.

#include <array>
#include <darkroom/param.hpp>

#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

/// Place of a colour on the disc, x to the right and y up. Grey is in the middle.
[[nodiscard]] std::array<double, 2> wheel_place(const std::array<double, 3>& rgb);
/// The colour there whose mean is `mean`.
[[nodiscard]] std::array<double, 3> wheel_color(const std::array<double, 2>& place, double mean);
/// What differs from the mean at the rim of the disc: a hand's reach, not the whole interval.
[[nodiscard]] double wheel_span(const ParamInfo& row, double usual);

/// Disc and slider of a row of Kind::Rgb, `width` wide. A drag moves the colour by as much as the mouse, ten times less
/// with Shift; a double click on the disc takes the colour out and leaves the mean.
[[nodiscard]] ValueEdit draw_wheel(const ParamInfo& row, std::span<std::uint32_t> words,
                                   std::span<const std::uint32_t> defaults, float width);

}  // namespace darkroom::panels
