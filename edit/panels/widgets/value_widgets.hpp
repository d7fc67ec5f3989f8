// SPDX-License-Identifier: MIT
#pragma once
// A value's widget, drawn from the row that describes it: sliders with interval and unit, choices, colours, curves. It
// knows the words of one value, and neither looks nor files.

#include <cstdint>
#include <darkroom/param.hpp>
#include <span>
#include <string>

namespace darkroom::panels {

/// What happened to a widget in this frame.
struct ValueEdit {
    bool is_changed = false;  ///< the words hold another value
    bool is_begun = false;    ///< a drag, a click or typing began: a step of its own to undo
};

/// Draws the widget of any row but a Resource, as wide as there is room, into the present ImGui window. `words` and
/// `defaults` are those of this row only. What is typed may lie outside of the interval: the document refuses it, and
/// says what is allowed.
[[nodiscard]] ValueEdit draw_value(const ParamInfo& row, std::span<std::uint32_t> words,
                                   std::span<const std::uint32_t> defaults);

/// How a curve is shown.
struct CurveShown {
    struct Other {
        std::span<const std::uint32_t> words;
        std::uint32_t color = 0;
    };
    std::span<const Other> behind{};  ///< curves that are seen, too
    std::uint32_t color = 0;          ///< as ImGui packs it; 0: that of text
    /// Both axes mean the same: a line shows what stays as it is, and beyond its ends the curve goes on beside it.
    bool has_identity = false;
};
/// The same for a curve: click to add a point, drag it, double-click to remove it; ctrl and the wheel change how much
/// is seen.
[[nodiscard]] ValueEdit draw_curve(const ParamInfo& row, std::span<std::uint32_t> words, const CurveShown& shown = {});

/// A value as flags take it: "0.08", "1.0,0.5,0.2", "on", "0.0:0.0,1.0:1.0". `words` as above.
[[nodiscard]] std::string flag_text(const ParamInfo& row, std::span<const std::uint32_t> words);

/// snake_case as people read it: "soft threshold".
[[nodiscard]] std::string shown_name(std::string_view name);

}  // namespace darkroom::panels
