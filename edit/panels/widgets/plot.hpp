// SPDX-License-Identifier: MIT
#pragma once
// What the panels that plot something share: a framed area at the cursor, places in it, colours of series.

#include <imgui.h>

#include <cstddef>

namespace darkroom::panels {

/// An area of the present window that something is drawn in.
struct Plot {
    ImDrawList* list = nullptr;
    ImVec2 min, max;
    bool is_hovered = false;
    ImVec2 mouse;  ///< from 0 to 1 from the lower left corner, where it is hovered

    /// (0, 0) is the lower left corner, (1, 1) the upper right one.
    [[nodiscard]] ImVec2 at(float x, float y) const {
        return {min.x + (max.x - min.x) * x, max.y - (max.y - min.y) * y};
    }
    void fill(float left, float bottom, float right, float top, ImU32 color) const {
        list->AddRectFilled(at(left, top), at(right, bottom), color);
    }
    void horizontal(float y, ImU32 color) const { list->AddLine(at(0, y), at(1, y), color); }
    void vertical(float x, ImU32 color) const { list->AddLine(at(x, 0), at(x, 1), color); }
};

/// At the cursor, which it moves behind the area; sizes of at least a pixel.
[[nodiscard]] Plot begin_plot(const char* id, ImVec2 size);
/// What is drawn stays inside the area until end_plot().
void end_plot(const Plot& plot);

[[nodiscard]] ImU32 grid_color();
/// The colour of the series of this number: twelve that differ, again and again.
[[nodiscard]] ImU32 series_color(std::size_t number);
/// Of a theme's colour, with this part of its opacity.
[[nodiscard]] ImU32 faded(ImU32 color, float part);

}  // namespace darkroom::panels
