// SPDX-License-Identifier: MIT
#pragma once
// Internal to edit/panels: a line of a panel, name to the left and widget to the right, and what all such lines share:
// the sentence and the interval while the mouse rests on it, a mark where the value is not the default, double click to
// reset, and a menu of its own.

#include <cstdint>
#include <darkroom/param.hpp>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "panels/panel_state.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

/// How wide the names of a panel's lines are, and where the widgets begin.
struct Columns {
    float name_width = 0;
    /// Of these names, in the present window: as wide as the longest, and half of the window at most.
    [[nodiscard]] static Columns of(std::span<const std::string> names);
};

/// A line that is no row's: a wire, a choice of the panel's own. `body` draws the widget.
void draw_line(const std::string& name, const char* sentence, const Columns& columns,
               const std::function<void()>& body);

struct RowLine {
    const ParamInfo* row = nullptr;
    std::span<const std::uint32_t> words;     ///< of this row
    std::span<const std::uint32_t> defaults;  ///< of this row
    std::string place;                        ///< "bloom.intensity"
    std::string flag, toml;                   ///< "--bloom-intensity 0.08" or none, "bloom_intensity = 0.08"
    const char* more = nullptr;               ///< another item of its menu
};
enum class RowAct : std::uint8_t { None, Change, Reset, More };
struct RowOutcome {
    RowAct act = RowAct::None;
    std::vector<std::uint32_t> words;  ///< of a change
};
/// Sentence, interval and text of the row, while the mouse rests on the last item.
void explain(const RowLine& line);
/// `body` draws the widget over a copy of the words; by default draw_value.
[[nodiscard]] RowOutcome draw_row(PanelState& state, const RowLine& line, const Columns& columns,
                                  const std::function<ValueEdit(std::span<std::uint32_t>)>& body = {});

/// The file's name, and buttons to choose another and to go without: `put` gets it, empty for none. `what`: the step.
void draw_file_choice(PanelState& state, const std::string& what, const std::string& file, FileKind kind,
                      const std::function<void(const std::string&)>& put);

/// Opacity, blend mode, scale, format and wires of an entry of a stack.
void draw_entry_state(PanelState& state, const LookEntry& entry, const std::string& name, const Columns& columns);
/// The names of its lines.
void add_state_names(std::vector<std::string>& names);

}  // namespace darkroom::panels
