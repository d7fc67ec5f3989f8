// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>

#include "panels/widgets/slider.hpp"
#include "panels/widgets/theme.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

namespace {

/// The visible part of the plane, and where it lies.
struct View {
    ImVec2 corner, size;  ///< in pixels
    float min_x, max_x, min_y, max_y;

    [[nodiscard]] ImVec2 place(float x, float y) const {
        return {corner.x + (x - min_x) / (max_x - min_x) * size.x, corner.y + (max_y - y) / (max_y - min_y) * size.y};
    }
    [[nodiscard]] float x_of(float pixel) const {
        return static_cast<float>(four_digits(min_x + (pixel - corner.x) / size.x * (max_x - min_x)));
    }
    [[nodiscard]] float y_of(float pixel) const {
        return static_cast<float>(four_digits(max_y - (pixel - corner.y) / size.y * (max_y - min_y)));
    }
};

Curve curve_of(std::span<const std::uint32_t> words) {
    std::array<std::uint32_t, sizeof(Curve) / 4> copy{};
    std::ranges::copy(words, copy.begin());
    Curve curve = std::bit_cast<Curve>(copy);
    curve.count = std::min<std::uint32_t>(curve.count, Curve::capacity);
    return curve;
}

void remove_point(Curve& curve, std::uint32_t point) {
    --curve.count;
    for (std::uint32_t i = point; i < curve.count; ++i) {
        curve.x[i] = curve.x[i + 1];
        curve.y[i] = curve.y[i + 1];
    }
    curve.x[curve.count] = curve.y[curve.count] = 0;
}

/// Keeps x ascending: a point does not pass its neighbours.
void move_point(Curve& curve, std::uint32_t point, float x, float y, const Range& range) {
    constexpr float far = std::numeric_limits<float>::max();
    if (point > 0) x = std::max(x, std::nextafter(curve.x[point - 1], far));
    if (point + 1 < curve.count) x = std::min(x, std::nextafter(curve.x[point + 1], -far));
    curve.x[point] = x;
    curve.y[point] = std::clamp(y, static_cast<float>(range.min), static_cast<float>(range.max));
}

/// The index of x among the points; nothing: a point has this x, or there is no room.
int add_point(Curve& curve, float x, float y, const Range& range) {
    if (curve.count == Curve::capacity) return -1;
    std::uint32_t at = 0;
    while (at < curve.count && curve.x[at] < x) ++at;
    if (at < curve.count && curve.x[at] == x) return -1;
    for (std::uint32_t i = curve.count; i > at; --i) {
        curve.x[i] = curve.x[i - 1];
        curve.y[i] = curve.y[i - 1];
    }
    ++curve.count;
    curve.x[at] = x;
    curve.y[at] = std::clamp(y, static_cast<float>(range.min), static_cast<float>(range.max));
    return static_cast<int>(at);
}

int point_at(const Curve& curve, const View& view, ImVec2 mouse, float reach) {
    int nearest = -1;
    float best = reach * reach;
    for (std::uint32_t i = 0; i < curve.count; ++i) {
        const ImVec2 place = view.place(curve.x[i], curve.y[i]);
        const float dx = place.x - mouse.x, dy = place.y - mouse.y;
        if (dx * dx + dy * dy <= best) {
            best = dx * dx + dy * dy;
            nearest = static_cast<int>(i);
        }
    }
    return nearest;
}

void paint_line(const Curve& curve, const View& view, ImU32 color, bool has_identity) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float thickness = 1.5f * ImGui::GetFontSize() / 15;
    if (curve.count == 0) {
        if (has_identity)
            list.AddLine(view.place(view.min_x, view.min_x), view.place(view.max_x, view.max_x), color, thickness);
        return;
    }
    std::array<ImVec2, Curve::capacity + 2> places;
    for (std::uint32_t i = 0; i < curve.count; ++i) places[i + 1] = view.place(curve.x[i], curve.y[i]);
    const std::uint32_t last = curve.count - 1;
    const float min_x = std::min(view.min_x, curve.x[0]), max_x = std::max(view.max_x, curve.x[last]);
    // Constant outside, or as far from the identity as the last point is.
    const float before = has_identity ? min_x - curve.x[0] : 0, behind = has_identity ? max_x - curve.x[last] : 0;
    places[0] = view.place(min_x, curve.y[0] + before);
    places[curve.count + 1] = view.place(max_x, curve.y[last] + behind);
    list.AddPolyline(places.data(), static_cast<int>(curve.count) + 2, color, 0, thickness);
}

void paint(const Curve& curve, const View& view, int chosen, const CurveShown& shown) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{view.corner.x + view.size.x, view.corner.y + view.size.y};
    const float unit = ImGui::GetFontSize() / 15;
    list.AddRectFilled(view.corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    list.PushClipRect(view.corner, end, true);
    const ImU32 line = ImGui::GetColorU32(ImGuiCol_Separator), axis = ImGui::GetColorU32(ImGuiCol_Border);
    for (int i = 1; i < 4; ++i) {
        const float part = static_cast<float>(i) / 4;
        const float x = std::round(view.corner.x + part * view.size.x);
        const float y = std::round(view.corner.y + part * view.size.y);
        list.AddLine({x, view.corner.y}, {x, end.y}, i == 2 ? axis : line, std::round(unit));
        list.AddLine({view.corner.x, y}, {end.x, y}, i == 2 ? axis : line, std::round(unit));
    }
    if (shown.has_identity) paint_line({}, view, axis, true);
    for (const CurveShown::Other& other : shown.behind)
        paint_line(curve_of(other.words), view, other.color, shown.has_identity);
    const ImU32 color = shown.color != 0 ? shown.color : ImGui::GetColorU32(ImGuiCol_Text);
    paint_line(curve, view, color, shown.has_identity);
    for (std::uint32_t i = 0; i < curve.count; ++i) {
        const bool is_chosen = static_cast<int>(i) == chosen;
        list.AddCircleFilled(view.place(curve.x[i], curve.y[i]), (is_chosen ? 5.0f : 3.5f) * unit,
                             is_chosen ? ImGui::GetColorU32(accent_color) : color);
    }
    list.PopClipRect();
    const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const float pad = ImGui::GetStyle().FramePadding.y;
    const std::string top = fmt::format("{:.3g}", view.max_y), bottom = fmt::format("{:.3g}", view.min_y);
    list.AddText({view.corner.x + pad, view.corner.y + pad}, dim, top.c_str());
    list.AddText({view.corner.x + pad, end.y - pad - ImGui::GetFontSize()}, dim, bottom.c_str());
    if (curve.count > 0) return;
    constexpr const char* hint = "click to add a point";
    const ImVec2 size = ImGui::CalcTextSize(hint);
    list.AddText({view.corner.x + (view.size.x - size.x) / 2, view.corner.y + (view.size.y * 0.75f - size.y) / 2}, dim,
                 hint);
}

/// The chosen point's numbers, to be dragged or typed.
bool edit_numbers(Curve& curve, std::uint32_t point, const Range& range, bool& is_begun) {
    std::array<float, 2> numbers{curve.x[point], curve.y[point]};
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool is_changed = ImGui::DragFloat2("##point", numbers.data(), 0.01f, 0, 0, "%.4g");
    is_begun |= ImGui::IsItemActivated();
    if (is_changed && std::isfinite(numbers[0]) && std::isfinite(numbers[1]))
        move_point(curve, point, numbers[0], numbers[1], range);
    return is_changed;
}

}  // namespace

ValueEdit draw_curve(const ParamInfo& row, std::span<std::uint32_t> words, const CurveShown& shown) {
    Curve curve = curve_of(words);
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID span_id = ImGui::GetID("span"), chosen_id = ImGui::GetID("chosen");
    const auto widest = static_cast<float>(std::max(std::abs(row.range.min), std::abs(row.range.max)));
    float farthest = std::min(widest, 4.0f);
    for (std::uint32_t i = 0; i < curve.count; ++i)
        farthest = std::max({farthest, std::abs(curve.x[i]), std::abs(curve.y[i])});
    float span = storage.GetFloat(span_id, farthest);
    int chosen = storage.GetInt(chosen_id, -1);
    if (chosen >= static_cast<int>(curve.count)) chosen = -1;

    const float width = std::max(1.0f, ImGui::GetContentRegionAvail().x), height = 9 * ImGui::GetFontSize();
    const float least = std::max(-span, static_cast<float>(row.range.min));
    const float most = std::min(span, static_cast<float>(row.range.max));
    const View view{ImGui::GetCursorScreenPos(), {width, height}, least, std::max(most, span), least, most};
    ValueEdit edit;
    ImGui::BeginGroup();
    ImGui::InvisibleButton("##value", view.size);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool is_hovered = ImGui::IsItemHovered();
    const float reach = ImGui::GetFontSize() * 0.6f;
    if (ImGui::IsItemActivated()) {
        edit.is_begun = true;
        chosen = point_at(curve, view, mouse, reach);
        if (chosen >= 0 && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
            remove_point(curve, static_cast<std::uint32_t>(chosen));
            chosen = -1;
            edit.is_changed = true;
        } else if (chosen < 0) {
            chosen = add_point(curve, view.x_of(mouse.x), view.y_of(mouse.y), row.range);
            edit.is_changed = chosen >= 0;
        }
    } else if (ImGui::IsItemActive() && chosen >= 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left)) {
        move_point(curve, static_cast<std::uint32_t>(chosen), view.x_of(mouse.x), view.y_of(mouse.y), row.range);
        edit.is_changed = true;
    }
    if (is_hovered && ImGui::GetIO().MouseWheel != 0 && ImGui::GetIO().KeyCtrl)
        span = std::clamp(span * std::pow(0.8f, ImGui::GetIO().MouseWheel), std::min(1.0f, widest), widest);
    paint(curve, view, chosen, shown);
    if (chosen >= 0)
        edit.is_changed |= edit_numbers(curve, static_cast<std::uint32_t>(chosen), row.range, edit.is_begun);
    ImGui::EndGroup();
    storage.SetFloat(span_id, span);
    storage.SetInt(chosen_id, chosen);
    if (edit.is_changed)
        std::ranges::copy(std::bit_cast<std::array<std::uint32_t, sizeof(Curve) / 4>>(curve), words.begin());
    return edit;
}

}  // namespace darkroom::panels
