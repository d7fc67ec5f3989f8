// SPDX-License-Identifier: MIT
#include "panels/widgets/value_widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>

#include "core/srgb.hpp"
#include "core/text/param_text.hpp"
#include "panels/widgets/slider.hpp"

namespace darkroom::panels {

namespace {

ValueEdit edit_of_last_item(bool is_changed) {
    return {.is_changed = is_changed, .is_begun = ImGui::IsItemActivated()};
}

/// Sliders of the words' numbers, side by side.
ValueEdit slide(const ParamInfo& row, std::span<std::uint32_t> words, std::span<const std::uint32_t> defaults) {
    const auto number_of = [&](std::uint32_t word) -> double {
        if (row.kind == Kind::Int) return static_cast<std::int32_t>(word);
        return std::bit_cast<float>(word);
    };
    const auto count = static_cast<float>(words.size());
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = std::floor((ImGui::CalcItemWidth() - gap * (count - 1)) / count);
    ValueEdit out;
    ImGui::BeginGroup();
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) ImGui::SameLine(0, gap);
        ImGui::SetNextItemWidth(width);
        double number = number_of(words[i]);
        const SliderEdit edit = draw_slider(fmt::format("{}", i).c_str(), row, number_of(defaults[i]), number);
        out.is_begun |= edit.is_begun;
        out.is_changed |= edit.is_changed;
        if (edit.is_changed)
            words[i] = row.kind == Kind::Int ? static_cast<std::uint32_t>(static_cast<std::int32_t>(number))
                                             : std::bit_cast<std::uint32_t>(static_cast<float>(number));
    }
    ImGui::EndGroup();
    return out;
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

/// A swatch that opens a picker, and the linear numbers beside it. Light above 1 is picked as a colour times a factor
/// that stays.
ValueEdit pick_color(const ParamInfo& row, std::span<std::uint32_t> words, std::span<const std::uint32_t> defaults) {
    std::array<float, 3> linear{}, shown{};
    for (std::size_t i = 0; i < 3; ++i) linear[i] = std::bit_cast<float>(words[i]);
    const float factor = std::max({1.0f, linear[0], linear[1], linear[2]});
    for (std::size_t i = 0; i < 3; ++i) shown[i] = srgb_encode(std::max(0.0f, linear[i] / factor));
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
    edit = slide(row, words, defaults);
    if (ImGui::BeginPopup("picker")) {
        if (ImGui::ColorPicker3("##picker", shown.data(), flags | ImGuiColorEditFlags_NoSidePreview)) {
            const auto least = static_cast<float>(row.range.min), most = static_cast<float>(row.range.max);
            for (std::size_t i = 0; i < 3; ++i)
                words[i] = std::bit_cast<std::uint32_t>(
                    std::clamp(static_cast<float>(four_digits(srgb_decode(shown[i]) * factor)), least, most));
            edit.is_changed = true;
        }
        edit.is_begun |= ImGui::IsItemActivated();
        ImGui::EndPopup();
    }
    ImGui::EndGroup();
    return edit;
}

}  // namespace

ValueEdit draw_value(const ParamInfo& row, std::span<std::uint32_t> words, std::span<const std::uint32_t> defaults) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    switch (row.kind) {
        case Kind::Toggle:
            return check_toggle(words);
        case Kind::Choice:
            return choose(row, words);
        case Kind::Rgb:
            return pick_color(row, words, defaults);
        case Kind::Curve:
            return draw_curve(row, words);
        default:
            return slide(row, words, defaults);
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
