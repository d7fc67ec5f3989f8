// SPDX-License-Identifier: MIT
#include "panels/widgets/slider.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/text/param_text.hpp"
#include "panels/widgets/text_field.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

double rounded(const ParamInfo& row, double number) {
    if (row.kind == Kind::Int) return std::round(number);
    return std::clamp(four_digits(number), row.range.min, row.range.max);
}

std::string text_of(const ParamInfo& row, double number) {
    return row.kind == Kind::Int ? fmt::format("{}", std::llround(number)) : fmt::format("{:.4g}", number);
}

/// The number at the right end of the slider, where the knob seldom is; without its unit if there is no room for both.
struct Label {
    std::string text;
    float x = 0, width = 0;
};
Label label_of(const ParamInfo& row, double number, float least, float most) {
    const float pad = std::min(ImGui::GetStyle().FramePadding.x, (most - least) / 10);
    Label label{.text = text_of(row, number)};
    if (!row.unit.symbol.empty()) {
        const std::string whole = fmt::format("{} {}", label.text, row.unit.symbol);
        if (ImGui::CalcTextSize(whole.c_str()).x <= most - least - 2 * pad) label.text = whole;
    }
    label.width = ImGui::CalcTextSize(label.text.c_str()).x;
    label.x = std::max(least, std::floor(most - pad - label.width));
    return label;
}

void paint(const SliderScale& scale, const ParamInfo& row, double usual, double number, bool is_held) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
    const float rounding = ImGui::GetStyle().FrameRounding;
    const float unit = std::max(1.0f, std::round(ImGui::GetFontSize() / 15));
    const auto x_of = [&](double value) {
        const double clamped = std::clamp(value, row.range.min, row.range.max);
        return std::round(least.x + (most.x - least.x) * static_cast<float>(scale.position(clamped)));
    };
    list.AddRectFilled(
        least, most, ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), rounding);
    const float from = x_of(0), to = x_of(number), left = std::min(from, to), right = std::max(from, to);
    if (right > left)
        list.AddRectFilled({left, least.y}, {right, most.y},
                           ImGui::GetColorU32(is_held ? ImGuiCol_HeaderActive : ImGuiCol_Header),
                           left <= least.x ? rounding : 0, ImDrawFlags_RoundCornersLeft);
    const float tick = x_of(usual);
    list.AddRectFilled({tick - unit / 2, most.y - 3 * unit}, {tick + unit / 2, most.y},
                       ImGui::GetColorU32(ImGuiCol_TextDisabled));
    const Label label = label_of(row, number, least.x, most.x);
    // Under the number, where it would cross it.
    const float knob = std::clamp(to, least.x + unit, most.x - unit);
    const bool crosses = knob > label.x - 2 * unit && knob < label.x + label.width + unit;
    list.AddRectFilled({knob - unit, crosses ? std::round(most.y - 5 * unit) : least.y}, {knob + unit, most.y},
                       is_held ? ImGui::GetColorU32(accent_color) : ImGui::GetColorU32(ImGuiCol_SliderGrab));
    list.PushClipRect(least, most, true);
    list.AddText({label.x, least.y + ImGui::GetStyle().FramePadding.y}, ImGui::GetColorU32(ImGuiCol_Text),
                 label.text.c_str());
    list.PopClipRect();
}

/// The field in the slider's place, until Enter, or a click elsewhere.
SliderEdit type_number(const ParamInfo& row, double& number, int& typing) {
    // Frames in which the field may wait for the keyboard: it has gone, and come back with its panel, after more.
    constexpr int max_waiting = 4;
    const bool is_new = typing == 0;
    static std::string typed;  // only one item of ImGui's is typed into at a time
    if (is_new) {
        typed = text_of(row, number);
        ImGui::SetKeyboardFocusHere();
    }
    const bool is_entered = text_field(
        "##typed", "", typed,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_CharsScientific);
    typing = ImGui::IsItemActive() ? 1 : typing + 1;
    if (!is_entered && !ImGui::IsItemDeactivated()) {
        if (typing > max_waiting) typing = 0;
        return {};
    }
    typing = 0;
    const auto parsed = parse_number(typed);
    const bool is_kind =
        parsed && (row.kind != Kind::Int || (*parsed == std::trunc(*parsed) && std::abs(*parsed) < 2e9));
    if (!is_kind || typed == text_of(row, number)) return {};
    number = *parsed;
    return {.is_changed = true, .is_begun = true};
}

}  // namespace

double four_digits(double number) {
    if (number == 0 || !std::isfinite(number)) return number;
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 3);
    return std::round(number / step) * step;
}

SliderScale::SliderScale(const Range& range, double usual, bool is_whole) : range_(range) {
    is_log_ = range.scale == Scale::Log;
    const double widest = std::max(std::abs(range.min), std::abs(range.max));
    const bool is_wide = widest > (is_whole ? 100 : 8) && widest > 20 * std::abs(usual);
    if (!is_log_ && is_wide) knee_ = usual == 0 ? widest / 1000 : std::abs(usual) / 10;
}

double SliderScale::spread(double value) const {
    if (is_log_) return std::log(value);
    return knee_ == 0 ? value : std::copysign(std::log1p(std::abs(value) / knee_), value);
}

double SliderScale::position(double value) const {
    const double least = spread(range_.min);
    return (spread(value) - least) / (spread(range_.max) - least);
}

double SliderScale::value(double position) const {
    const double least = spread(range_.min);
    const double at = least + position * (spread(range_.max) - least);
    double number = at;
    if (is_log_)
        number = std::exp(at);
    else if (knee_ != 0)
        number = std::copysign(knee_ * std::expm1(std::abs(at)), at);
    return std::clamp(number, range_.min, range_.max);
}

SliderEdit draw_slider(const char* id, const ParamInfo& row, double usual, double& number) {
    ImGui::PushID(id);
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID typing_id = ImGui::GetID("typing");
    int typing = storage.GetInt(typing_id);
    SliderEdit edit;
    if (typing > 0) {
        edit = type_number(row, number, typing);
        storage.SetInt(typing_id, typing);
        ImGui::PopID();
        return edit;
    }
    const SliderScale scale(row.range, usual, row.kind == Kind::Int);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = std::max(1.0f, ImGui::CalcItemWidth());
    ImGui::InvisibleButton("##slider", {width, ImGui::GetFrameHeight()});
    const ImGuiIO& io = ImGui::GetIO();
    edit.is_begun = ImGui::IsItemActivated();
    const bool is_held = ImGui::IsItemActive();
    if (edit.is_begun && io.KeyCtrl) {
        ImGui::SetCursorScreenPos(corner);
        ImGui::SetNextItemWidth(width);
        edit = type_number(row, number, typing);
        storage.SetInt(typing_id, typing);
    } else if (is_held) {
        double position = (io.MousePos.x - corner.x) / width;
        if (io.KeyShift) position = scale.position(number) + io.MouseDelta.x / width / 10;
        const double wanted = rounded(row, scale.value(std::clamp(position, 0.0, 1.0)));
        const bool moves = edit.is_begun ? !io.KeyShift : io.MouseDelta.x != 0;
        edit.is_changed = moves && wanted != number;
        if (edit.is_changed) number = wanted;
    }
    if (typing == 0) paint(scale, row, usual, number, is_held);
    ImGui::PopID();
    return edit;
}

}  // namespace darkroom::panels
