// SPDX-License-Identifier: MIT
#include "panels/widgets/theme.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

namespace darkroom::panels {

namespace {

ImVec4 grey(float value, float alpha = 1.0f) { return {value, value, value, alpha}; }
ImVec4 accent(float alpha) { return {accent_color.x, accent_color.y, accent_color.z, alpha}; }

void set_colors(ImVec4* colors) {
    // What the lists below do not name is drawn by nothing here, and stays ImGui's.
    constexpr auto shades = std::to_array<std::pair<ImGuiCol, float>>({{ImGuiCol_Text, 0.86f},
                                                                       {ImGuiCol_TextDisabled, 0.54f},
                                                                       {ImGuiCol_WindowBg, 0.155f},
                                                                       {ImGuiCol_PopupBg, 0.125f},
                                                                       {ImGuiCol_Border, 0.255f},
                                                                       {ImGuiCol_FrameBg, 0.095f},
                                                                       {ImGuiCol_FrameBgHovered, 0.12f},
                                                                       {ImGuiCol_FrameBgActive, 0.135f},
                                                                       {ImGuiCol_TitleBg, 0.115f},
                                                                       {ImGuiCol_TitleBgActive, 0.135f},
                                                                       {ImGuiCol_TitleBgCollapsed, 0.115f},
                                                                       {ImGuiCol_MenuBarBg, 0.135f},
                                                                       {ImGuiCol_ScrollbarGrab, 0.30f},
                                                                       {ImGuiCol_ScrollbarGrabHovered, 0.38f},
                                                                       {ImGuiCol_ScrollbarGrabActive, 0.46f},
                                                                       {ImGuiCol_SliderGrab, 0.52f},
                                                                       {ImGuiCol_Button, 0.235f},
                                                                       {ImGuiCol_ButtonHovered, 0.295f},
                                                                       {ImGuiCol_ButtonActive, 0.345f},
                                                                       {ImGuiCol_Header, 0.255f},
                                                                       {ImGuiCol_HeaderHovered, 0.285f},
                                                                       {ImGuiCol_HeaderActive, 0.325f},
                                                                       {ImGuiCol_Separator, 0.225f},
                                                                       {ImGuiCol_SeparatorHovered, 0.35f},
                                                                       {ImGuiCol_ResizeGrip, 0.25f},
                                                                       {ImGuiCol_ResizeGripHovered, 0.35f},
                                                                       {ImGuiCol_Tab, 0.155f},
                                                                       {ImGuiCol_TabHovered, 0.295f},
                                                                       {ImGuiCol_TabActive, 0.235f},
                                                                       {ImGuiCol_TabUnfocused, 0.155f},
                                                                       {ImGuiCol_TabUnfocusedActive, 0.215f},
                                                                       {ImGuiCol_TableHeaderBg, 0.18f},
                                                                       {ImGuiCol_TableBorderStrong, 0.225f},
                                                                       {ImGuiCol_TableBorderLight, 0.19f},
                                                                       {ImGuiCol_PlotLines, 0.70f},
                                                                       {ImGuiCol_PlotHistogram, 0.60f}});
    for (const auto& [color, value] : shades) colors[color] = grey(value);
    for (const ImGuiCol color :
         {ImGuiCol_SliderGrabActive, ImGuiCol_CheckMark, ImGuiCol_SeparatorActive, ImGuiCol_ResizeGripActive,
          ImGuiCol_DragDropTarget, ImGuiCol_NavHighlight, ImGuiCol_PlotLinesHovered, ImGuiCol_PlotHistogramHovered})
        colors[color] = accent(1.0f);
    colors[ImGuiCol_TextSelectedBg] = accent(0.35f);
    for (const ImGuiCol color : {ImGuiCol_ChildBg, ImGuiCol_BorderShadow, ImGuiCol_ScrollbarBg, ImGuiCol_TableRowBg})
        colors[color] = grey(0, 0);
    colors[ImGuiCol_TableRowBgAlt] = grey(1, 0.02f);
    colors[ImGuiCol_ModalWindowDimBg] = grey(0, 0.5f);
}

}  // namespace

void apply_theme(float scale) {
    ImGuiStyle style;
    style.WindowPadding = {10, 10};
    style.FramePadding = {8, 4};
    style.CellPadding = {6, 3};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 18;
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = 4;
    style.ChildRounding = 3;
    style.FrameRounding = 3;
    style.PopupRounding = 4;
    style.ScrollbarRounding = 6;
    style.GrabRounding = 2;
    style.TabRounding = 3;
    style.WindowTitleAlign = {0.0f, 0.5f};
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ScaleAllSizes(scale);
    // Lines are as wide as they must be to be seen, and no wider.
    style.WindowBorderSize = style.PopupBorderSize = std::max(1.0f, std::floor(scale));
    set_colors(style.Colors);
    ImGui::GetStyle() = style;

    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    const float pixels = std::round(15.0f * scale);
    for (const char* const file :
         {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
          "/usr/share/fonts/TTF/DejaVuSans.ttf"}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error) && fonts.AddFontFromFileTTF(file, pixels) != nullptr) return;
    }
    ImFontConfig config;
    config.SizePixels = std::max(13.0f, std::floor(scale) * 13.0f);
    fonts.AddFontDefault(&config);
}

}  // namespace darkroom::panels
