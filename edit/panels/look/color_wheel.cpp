// SPDX-License-Identifier: MIT
#include "panels/look/color_wheel.hpp"

#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "panels/widgets/slider.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

constexpr double degree = std::numbers::pi / 180;
/// Near those of a vectorscope (ITU-R BT.709), and 120 degrees apart.
constexpr std::array<double, 3> angles{105 * degree, 225 * degree, 345 * degree};

double mean_of(const std::array<double, 3>& rgb) { return (rgb[0] + rgb[1] + rgb[2]) / 3; }

std::array<double, 3> numbers_of(std::span<const std::uint32_t> words) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = double{std::bit_cast<float>(words[i])};
    return out;
}

void put(const ParamInfo& row, const std::array<double, 3>& rgb, std::span<std::uint32_t> words) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double number = std::clamp(std::round(rgb[i] * 1e4) / 1e4, row.range.min, row.range.max);
        words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    }
}

void paint(ImVec2 middle, float radius, const std::array<double, 2>& place, bool is_held) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(middle, radius, ImGui::GetColorU32(ImGuiCol_FrameBg), 64);
    constexpr int parts = 48;
    const float thickness = std::max(2.0F, std::round(radius / 14));
    for (int i = 0; i < parts; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / parts, half = std::numbers::pi / parts * 1.1;
        const std::array<double, 3> color = wheel_color({0.3 * std::cos(angle), 0.3 * std::sin(angle)}, 0.5);
        list.PathArcTo(middle, radius - thickness / 2, static_cast<float>(-angle - half),
                       static_cast<float>(-angle + half), 3);
        list.PathStroke(ImGui::ColorConvertFloat4ToU32({static_cast<float>(color[0]), static_cast<float>(color[1]),
                                                        static_cast<float>(color[2]), 1}),
                        ImDrawFlags_None, thickness);
    }
    const ImU32 line = ImGui::GetColorU32(ImGuiCol_Separator);
    list.AddLine({middle.x - radius + thickness, middle.y}, {middle.x + radius - thickness, middle.y}, line);
    list.AddLine({middle.x, middle.y - radius + thickness}, {middle.x, middle.y + radius - thickness}, line);
    const double length = std::hypot(place[0], place[1]), most = std::max(length, 1.0);
    const float reach = radius - 2 * thickness;
    const ImVec2 at{middle.x + reach * static_cast<float>(place[0] / most),
                    middle.y - reach * static_cast<float>(place[1] / most)};
    list.AddCircleFilled(at, radius * 0.09F, ImGui::GetColorU32(is_held ? accent_color : ImVec4{1, 1, 1, 1}));
    list.AddCircle(at, radius * 0.09F, IM_COL32(0, 0, 0, 255));
}

}  // namespace

std::array<double, 2> wheel_place(const std::array<double, 3>& rgb) {
    const double mean = mean_of(rgb);
    std::array<double, 2> out{};
    for (std::size_t i = 0; i < 3; ++i) {
        out[0] += 2.0 / 3 * (rgb[i] - mean) * std::cos(angles[i]);
        out[1] += 2.0 / 3 * (rgb[i] - mean) * std::sin(angles[i]);
    }
    return out;
}

std::array<double, 3> wheel_color(const std::array<double, 2>& place, double mean) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = mean + place[0] * std::cos(angles[i]) + place[1] * std::sin(angles[i]);
    return out;
}

double wheel_span(const ParamInfo& row, double usual) { return usual != 0 ? std::abs(usual) / 2 : row.range.max / 4; }

ValueEdit draw_wheel(const ParamInfo& row, std::span<std::uint32_t> words, std::span<const std::uint32_t> defaults,
                     float width) {
    const double usual = mean_of(numbers_of(defaults)), span = wheel_span(row, usual);
    const std::array<double, 3> rgb = numbers_of(words);
    const double mean = mean_of(rgb);
    std::array<double, 2> place = wheel_place(rgb);
    ValueEdit edit;
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("##disc", {width, width});
    const float radius = width / 2;
    edit.is_begun = ImGui::IsItemActivated();
    const bool is_held = ImGui::IsItemActive();
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        edit.is_changed = place[0] != 0 || place[1] != 0;
        place = {};
    } else if (is_held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
        const ImVec2 by = ImGui::GetIO().MouseDelta;
        const double scale = span / static_cast<double>(radius) * (ImGui::GetIO().KeyShift ? 0.1 : 1);
        place[0] += static_cast<double>(by.x) * scale;
        place[1] -= static_cast<double>(by.y) * scale;
        edit.is_changed = by.x != 0 || by.y != 0;
    }
    if (edit.is_changed) put(row, wheel_color(place, mean), words);
    paint({corner.x + radius, corner.y + radius}, radius, {place[0] / span, place[1] / span}, is_held);
    ImGui::SetNextItemWidth(width);
    double master = mean;
    const SliderEdit slid = draw_slider("##mean", row, usual, master);
    if (slid.is_changed) {
        edit.is_changed = true;
        put(row, wheel_color(place, master), words);
    }
    edit.is_begun |= slid.is_begun;
    ImGui::EndGroup();
    return edit;
}

}  // namespace darkroom::panels
