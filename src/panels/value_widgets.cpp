// SPDX-License-Identifier: MIT
#include "panels/value_widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>

#include "core/param_text.hpp"

namespace darkroom::panels {

namespace {

ValueEdit edit_of_last_item(bool is_changed) {
    return {.is_changed = is_changed, .is_begun = ImGui::IsItemActivated()};
}

/// Of an interval like [0, 65504] an even slider has all that matters in its first pixel.
bool is_in_ratios(const ParamInfo& row) {
    return row.range.scale == Scale::Log || std::max(std::abs(row.range.min), std::abs(row.range.max)) > 8;
}

ImGuiSliderFlags slider_flags(const ParamInfo& row) {
    return ImGuiSliderFlags_AlwaysClamp | (is_in_ratios(row) ? ImGuiSliderFlags_Logarithmic : 0);
}

std::string number_format(const ParamInfo& row, const char* number) {
    return row.unit.symbol.empty() ? number : fmt::format("{} {}", number, row.unit.symbol);
}

/// Sliders of floats, side by side.
ValueEdit slide_floats(const ParamInfo& row, std::span<std::uint32_t> words) {
    std::array<float, 4> numbers{};
    for (std::size_t i = 0; i < words.size(); ++i) numbers[i] = std::bit_cast<float>(words[i]);
    const auto least = static_cast<float>(row.range.min), most = static_cast<float>(row.range.max);
    const std::string format = number_format(row, "%.4g");
    const bool is_changed =
        ImGui::SliderScalarN("##value", ImGuiDataType_Float, numbers.data(), static_cast<int>(words.size()), &least,
                             &most, format.c_str(), slider_flags(row));
    if (is_changed)
        for (std::size_t i = 0; i < words.size(); ++i)
            words[i] = std::bit_cast<std::uint32_t>(std::clamp(numbers[i], least, most));
    return edit_of_last_item(is_changed);
}

ValueEdit slide_whole(const ParamInfo& row, std::span<std::uint32_t> words) {
    std::int64_t number = static_cast<std::int32_t>(words[0]);
    const auto least = static_cast<std::int64_t>(row.range.min), most = static_cast<std::int64_t>(row.range.max);
    const std::string format = number_format(row, "%lld");
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (most - least > 1024 ? ImGuiSliderFlags_Logarithmic : 0);
    const bool is_changed =
        ImGui::SliderScalar("##value", ImGuiDataType_S64, &number, &least, &most, format.c_str(), flags);
    if (is_changed) words[0] = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(number, least, most)));
    return edit_of_last_item(is_changed);
}

ValueEdit check_toggle(std::span<std::uint32_t> words) {
    bool is_on = words[0] != 0;
    const bool is_changed = ImGui::Checkbox("##value", &is_on);
    if (is_changed) words[0] = is_on ? 1 : 0;
    return edit_of_last_item(is_changed);
}

ValueEdit choose(const ParamInfo& row, std::span<std::uint32_t> words) {
    const std::string present = words[0] < row.choices.size() ? shown_name(row.choices[words[0]]) : std::string();
    ValueEdit edit;
    if (!ImGui::BeginCombo("##value", present.c_str(), ImGuiComboFlags_HeightLarge)) return edit;
    for (std::uint32_t i = 0; i < row.choices.size(); ++i) {
        const bool is_present = i == words[0];
        if (ImGui::Selectable(shown_name(row.choices[i]).c_str(), is_present) && !is_present) {
            words[0] = i;
            edit = {.is_changed = true, .is_begun = true};
        }
        if (is_present) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
    return edit;
}

// IEC 61966-2-1: what ImGui's colours are meant to be.
float encoded(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}
float decoded(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

// Four significant digits: what a slider gives, too.
float rounded(float number) {
    if (number == 0 || !std::isfinite(number)) return number;
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 3);
    return static_cast<float>(std::round(number / step) * step);
}

/// A swatch that opens a picker, and the linear numbers beside it. Light above 1 is picked as a colour times a factor
/// that stays.
ValueEdit pick_color(const ParamInfo& row, std::span<std::uint32_t> words) {
    std::array<float, 3> linear{}, shown{};
    for (std::size_t i = 0; i < 3; ++i) linear[i] = std::bit_cast<float>(words[i]);
    const float factor = std::max({1.0f, linear[0], linear[1], linear[2]});
    for (std::size_t i = 0; i < 3; ++i) shown[i] = encoded(std::max(0.0f, linear[i] / factor));
    ValueEdit edit;
    const float width = ImGui::CalcItemWidth(), height = ImGui::GetFrameHeight();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::BeginGroup();
    constexpr ImGuiColorEditFlags flags =
        ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop | ImGuiColorEditFlags_NoAlpha;
    if (ImGui::ColorButton("##swatch", {shown[0], shown[1], shown[2], 1}, flags, {height, height}))
        ImGui::OpenPopup("picker");
    ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(width - height - gap);
    edit = slide_floats(row, words);
    if (ImGui::BeginPopup("picker")) {
        if (ImGui::ColorPicker3("##picker", shown.data(), flags | ImGuiColorEditFlags_NoSidePreview)) {
            const auto least = static_cast<float>(row.range.min), most = static_cast<float>(row.range.max);
            for (std::size_t i = 0; i < 3; ++i)
                words[i] = std::bit_cast<std::uint32_t>(std::clamp(rounded(decoded(shown[i]) * factor), least, most));
            edit.is_changed = true;
        }
        edit.is_begun |= ImGui::IsItemActivated();
        ImGui::EndPopup();
    }
    ImGui::EndGroup();
    return edit;
}

}  // namespace

ValueEdit draw_value(const ParamInfo& row, std::span<std::uint32_t> words) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    switch (row.kind) {
        case Kind::Int:
            return slide_whole(row, words);
        case Kind::Toggle:
            return check_toggle(words);
        case Kind::Choice:
            return choose(row, words);
        case Kind::Rgb:
            return pick_color(row, words);
        case Kind::Curve:
            return draw_curve(row, words);
        default:
            return slide_floats(row, words);
    }
}

std::string flag_text(const ParamInfo& row, std::span<const std::uint32_t> words) {
    if (row.kind == Kind::Toggle) return words[0] != 0 ? "on" : "off";
    if (row.kind == Kind::Choice) return std::string(words[0] < row.choices.size() ? row.choices[words[0]] : "");
    ParamInfo alone = row;
    alone.word = 0;
    // "[[0.0, 1.0], [1.0, 0.5]]" to "0.0:1.0,1.0:0.5".
    std::string out;
    int depth = 0;
    for (const char letter : format(alone, words)) {
        if (letter == '[') ++depth;
        if (letter == ']') --depth;
        if (letter == '[' || letter == ']' || letter == ' ') continue;
        out += letter == ',' && depth == 2 ? ':' : letter;
    }
    return out;
}

std::string shown_name(std::string_view name) {
    std::string out(name);
    std::ranges::replace(out, '_', ' ');
    return out;
}

}  // namespace darkroom::panels
