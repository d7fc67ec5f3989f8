// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "panels/test_gui.hpp"

namespace darkroom::panels {
namespace {

float saturation(const ImVec4& color) {
    const float most = std::max({color.x, color.y, color.z}), least = std::min({color.x, color.y, color.z});
    return most == 0 ? 0 : (most - least) / most;
}

TEST(PanelTheme, HasOneColorBesideGreys) {
    const TestGui gui(640, 480, 1);
    const ImVec4* const colors = ImGui::GetStyle().Colors;
    for (int i = 0; i < ImGuiCol_COUNT; ++i) {
        const bool is_accent = colors[i].x == accent_color.x && colors[i].y == accent_color.y;
        EXPECT_LT(is_accent ? 0 : saturation(colors[i]), 0.01f) << ImGui::GetStyleColorName(i);
    }
    EXPECT_GT(colors[ImGuiCol_Text].x - colors[ImGuiCol_WindowBg].x, 0.5f);
}

TEST(PanelTheme, ScalesFontAndSpaces) {
    float height = 0, padding = 0;
    for (const float scale : {1.0f, 2.0f, 2.5f}) {
        TestGui gui(640, 480, scale);
        gui.draw = [&] {
            EXPECT_GE(ImGui::GetFontSize(), 13.0f * std::floor(scale));
            height = ImGui::GetFrameHeight() / scale;
            padding = ImGui::GetStyle().WindowPadding.x / scale;
        };
        gui.frame();
        EXPECT_NEAR(height, 23.0f, 1.0f);
        EXPECT_EQ(padding, 10.0f);
    }
}

TEST(PanelTheme, IsAppliedAgainForAnotherDisplay) {
    TestGui gui(640, 480, 1);
    gui.draw = [] {};
    gui.frame();
    apply_theme(2);
    ImGui::GetIO().Fonts->Build();
    gui.draw = [] { EXPECT_GE(ImGui::GetFontSize(), 26.0f); };
    gui.frame();
}

}  // namespace
}  // namespace darkroom::panels
