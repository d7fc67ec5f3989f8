// SPDX-License-Identifier: MIT
#pragma once
// Internal to edit/panels: the parameters of the selected entry, line by line, or in groups of widgets where an effect
// has so many colours that lines hide what they are.

#include <array>
#include <darkroom/effect.hpp>
#include <darkroom/param.hpp>
#include <string>
#include <vector>

#include "panels/look/parameter_row.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

[[nodiscard]] RowLine line_of(const PanelState& state, const LookEntry& entry, const std::string& name,
                              const ParamInfo& row);
/// Makes what happened to a line an edit.
void apply(PanelState& state, const std::string& name, const RowLine& line, const RowOutcome& outcome);
void draw_parameter(PanelState& state, const LookEntry& entry, const std::string& name, const ParamInfo& row,
                    const Columns& columns);

/// Parameters that are held together.
struct RowGroup {
    enum class Kind : std::uint8_t {
        Lines,     ///< each by itself
        Wheels,    ///< three colours side by side, and lines that belong to them
        Curves,    ///< of red, green and blue in one plot
        Channels,  ///< lines of red, green and blue
    };
    Kind kind = Kind::Lines;
    std::string name;
    std::vector<const ParamInfo*> rows;  ///< of Wheels the first three are the colours
};
/// Of an effect with three colours in a row; else none. They are found by kinds and names: what ends in _red, _green
/// and _blue is one thing, and what begins with a colour's name belongs to it.
[[nodiscard]] std::vector<RowGroup> groups_of(const EffectInfo& effect);
/// False: the effect has no groups, or its user wants numbers.
[[nodiscard]] bool draw_grouped_rows(PanelState& state, const LookEntry& entry, const std::string& name);

// Three numbers, of red, green and blue, as colourists hold them: their mean on a slider, and what each differs from it
// as a place on a disc, with red, green and blue 120 degrees apart as on a vectorscope.

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
