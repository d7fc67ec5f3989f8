// SPDX-License-Identifier: MIT
#include "panels/widgets/plot.hpp"

#include <algorithm>
#include <array>

namespace darkroom::panels {

Plot begin_plot(const char* id, ImVec2 size) {
    const ImVec2 extent{std::max(size.x, 1.0f), std::max(size.y, 1.0f)};
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(id, extent);
    Plot plot{.list = ImGui::GetWindowDrawList(),
              .min = corner,
              .max = {corner.x + extent.x, corner.y + extent.y},
              .is_hovered = ImGui::IsItemHovered()};
    const ImVec2 mouse = ImGui::GetMousePos();
    if (plot.is_hovered) plot.mouse = {(mouse.x - corner.x) / extent.x, (plot.max.y - mouse.y) / extent.y};
    plot.list->AddRectFilled(plot.min, plot.max, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    plot.list->PushClipRect(plot.min, plot.max, true);
    return plot;
}

void end_plot(const Plot& plot) { plot.list->PopClipRect(); }

ImU32 grid_color() { return ImGui::GetColorU32(ImGuiCol_Text, 0.10f); }

ImU32 series_color(std::size_t number) {
    // Of about equal lightness, neighbours far apart in hue.
    constexpr std::array colors{
        IM_COL32(106, 147, 201, 255), IM_COL32(214, 151, 84, 255), IM_COL32(118, 171, 112, 255),
        IM_COL32(190, 113, 137, 255), IM_COL32(98, 173, 176, 255), IM_COL32(196, 180, 96, 255),
        IM_COL32(149, 124, 196, 255), IM_COL32(203, 122, 94, 255), IM_COL32(150, 165, 90, 255),
        IM_COL32(176, 126, 178, 255), IM_COL32(88, 152, 138, 255), IM_COL32(160, 150, 138, 255)};
    return colors[number % colors.size()];
}

ImU32 faded(ImU32 color, float part) {
    ImVec4 channels = ImGui::ColorConvertU32ToFloat4(color);
    channels.w *= part;
    return ImGui::ColorConvertFloat4ToU32(channels);
}

}  // namespace darkroom::panels
