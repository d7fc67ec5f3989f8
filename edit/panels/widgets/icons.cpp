// SPDX-License-Identifier: MIT
#include "panels/widgets/icons.hpp"

#include <imgui.h>

#include <cmath>
#include <initializer_list>

namespace darkroom::panels {

namespace {

/// Draws in a square of 16 units.
class Pen {
  public:
    Pen(ImVec2 corner, float side, ImU32 color)
        : list_(*ImGui::GetWindowDrawList()), corner_(corner), unit_(side / 16), color_(color) {}

    void line(std::initializer_list<ImVec2> points, bool is_closed = false) {
        for (const ImVec2& point : points) list_.PathLineTo(at(point));
        list_.PathStroke(color_, is_closed ? ImDrawFlags_Closed : ImDrawFlags_None, width());
    }
    void curve(ImVec2 from, ImVec2 over, ImVec2 to) {
        list_.PathLineTo(at(from));
        list_.PathBezierQuadraticCurveTo(at(over), at(to), 12);
        list_.PathStroke(color_, ImDrawFlags_None, width());
    }
    void arc(ImVec2 center, float radius, float from, float to) {
        list_.PathArcTo(at(center), radius * unit_, from, to, 20);
        list_.PathStroke(color_, ImDrawFlags_None, width());
    }
    void dot(ImVec2 center, float radius) { list_.AddCircleFilled(at(center), radius * unit_, color_, 16); }
    void box(ImVec2 from, ImVec2 to) { line({from, {to.x, from.y}, to, {from.x, to.y}}, true); }

  private:
    [[nodiscard]] ImVec2 at(ImVec2 point) const { return {corner_.x + point.x * unit_, corner_.y + point.y * unit_}; }
    [[nodiscard]] float width() const { return 1.2f * unit_; }

    ImDrawList& list_;
    ImVec2 corner_;
    float unit_;
    ImU32 color_;
};

void turn_back(Pen& pen, float sign) {
    const auto x = [&](float from_center) { return 8 + sign * from_center; };
    pen.line({{x(-1.5f), 3}, {x(-4.5f), 6}, {x(-1.5f), 9}});
    pen.line({{x(-4.5f), 6}, {x(1.5f), 6}});
    pen.curve({x(1.5f), 6}, {x(5.5f), 6}, {x(5.5f), 9.5f});
    pen.curve({x(5.5f), 9.5f}, {x(5.5f), 13}, {x(1.5f), 13});
    pen.line({{x(1.5f), 13}, {x(-2), 13}});
}

void draw(Pen& pen, Icon icon) {
    constexpr float pi = 3.14159265f;
    switch (icon) {
        case Icon::Shown:
            pen.curve({1.5f, 8}, {8, 1}, {14.5f, 8});
            pen.curve({1.5f, 8}, {8, 15}, {14.5f, 8});
            pen.dot({8, 8}, 2.2f);
            break;
        case Icon::Hidden:
            pen.curve({1.5f, 7.5f}, {8, 13.5f}, {14.5f, 7.5f});
            pen.line({{4, 9.6f}, {2.8f, 11.6f}});
            pen.line({{8, 10.5f}, {8, 12.9f}});
            pen.line({{12, 9.6f}, {13.2f, 11.6f}});
            break;
        case Icon::Duplicate:
            pen.box({5.5f, 5.5f}, {13, 13});
            pen.line({{10.5f, 3}, {3, 3}, {3, 10.5f}});
            break;
        case Icon::Remove:
            pen.line({{4.5f, 4.5f}, {11.5f, 11.5f}});
            pen.line({{11.5f, 4.5f}, {4.5f, 11.5f}});
            break;
        case Icon::Undo:
            turn_back(pen, 1);
            break;
        case Icon::Redo:
            turn_back(pen, -1);
            break;
        case Icon::Save:
            pen.line({{3, 3}, {11, 3}, {13, 5}, {13, 13}, {3, 13}}, true);
            pen.box({5.5f, 9}, {10.5f, 13});
            pen.line({{6, 3}, {6, 6}, {10, 6}, {10, 3}});
            break;
        case Icon::SaveAs:
            pen.line({{7.5f, 12}, {2.5f, 12}, {2.5f, 3}, {9, 3}, {11, 5}, {11, 7.5f}});
            pen.line({{5, 3}, {5, 6}, {8.5f, 6}, {8.5f, 3}});
            pen.line({{11.5f, 9.5f}, {11.5f, 14.5f}});
            pen.line({{9, 12}, {14, 12}});
            break;
        case Icon::Reset:
            pen.arc({8, 8.5f}, 4.5f, -0.9f * pi + 0.6f, 0.75f * pi);
            pen.line({{3.4f, 3}, {4.4f, 6.6f}, {8, 6}});
            break;
        case Icon::Up:
            pen.line({{8, 13}, {8, 3.5f}});
            pen.line({{4, 7.5f}, {8, 3.5f}, {12, 7.5f}});
            break;
    }
}

}  // namespace

bool icon_button(const char* id, Icon icon, const char* text, bool is_dim) {
    const float side = ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool is_pressed = ImGui::InvisibleButton(id, {side, side});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::GetWindowDrawList()->AddRectFilled(
            corner, {corner.x + side, corner.y + side},
            ImGui::GetColorU32(ImGui::IsItemActive() ? ImGuiCol_ButtonActive : ImGuiCol_ButtonHovered),
            ImGui::GetStyle().FrameRounding);
    const float inset = std::round(side * 0.14f);
    Pen pen({corner.x + inset, corner.y + inset}, side - 2 * inset,
            ImGui::GetColorU32(is_dim ? ImGuiCol_TextDisabled : ImGuiCol_Text));
    draw(pen, icon);
    if (text != nullptr) tooltip(text);
    return is_pressed;
}

bool is_rested_on() {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsAnyMouseDown()) return false;
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID still_id = ImGui::GetID("still since");
    const auto now = static_cast<float>(ImGui::GetTime());
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (moved.x != 0 || moved.y != 0 || ImGui::IsWindowAppearing()) storage.SetFloat(still_id, now);
    return now - storage.GetFloat(still_id) > 0.4f;
}

void tooltip(const char* text) {
    if (!is_rested_on()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

}  // namespace darkroom::panels
