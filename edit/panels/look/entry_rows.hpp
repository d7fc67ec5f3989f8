// SPDX-License-Identifier: MIT
#pragma once
// Internal to edit/panels: the parameters of the selected entry, line by line, or in groups of widgets where an effect
// has so many colours that lines hide what they are.

#include <darkroom/effect.hpp>
#include <string>
#include <vector>

#include "panels/look/parameter_row.hpp"

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

}  // namespace darkroom::panels
