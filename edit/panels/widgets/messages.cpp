// SPDX-License-Identifier: MIT
#include "panels/widgets/messages.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <charconv>

#include "core/text/param_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

float text_width(float width) { return width - ImGui::GetFrameHeight() - 3 * ImGui::GetStyle().ItemSpacing.x; }
float text_height(const std::string& text, float width) {
    const float height = ImGui::CalcTextSize(text.c_str(), nullptr, false, text_width(width)).y;
    return std::max(height + 2 * ImGui::GetStyle().FramePadding.y, ImGui::GetFrameHeight());
}

std::string shown(const Messages::Entry& entry) {
    return entry.count > 1 ? fmt::format("{}  ({} times)", entry.text, entry.count) : entry.text;
}

ImU32 color_of(Severity severity) {
    if (severity == Severity::Error) return ImGui::GetColorU32(error_color);
    return ImGui::GetColorU32(severity == Severity::Warning ? accent_color
                                                            : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
}

/// The digits of `text` from `at` on, followed by a colon, behind which `at` is then.
std::optional<std::size_t> number_at(std::string_view text, std::size_t& at) {
    std::size_t number = 0;
    const char* const begin = text.data() + at;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
    if (error != std::errc() || end == text.data() + text.size() || *end != ':') return std::nullopt;
    at += static_cast<std::size_t>(end - begin) + 1;
    return number;
}

}  // namespace

std::optional<TextPlace> place_in(std::string_view text) {
    for (std::size_t colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':', colon + 1)) {
        std::size_t at = colon + 1;
        const std::optional<std::size_t> line = number_at(text, at);
        if (!line || *line == 0 || colon == 0) continue;
        const std::optional<std::size_t> column = number_at(text, at);
        return TextPlace{std::string(text.substr(0, colon)), *line, column.value_or(0)};
    }
    return std::nullopt;
}

void Messages::say(std::string_view source, std::span<const Said> all) {
    const auto is_said = [&](const Entry& entry) {
        return std::ranges::any_of(all, [&](const Said& said) { return printable(said.text) == entry.text; });
    };
    for (Entry& entry : entries_)
        if (!is_said(entry) && std::erase(entry.sources, source) > 0) ++version_;
    for (const Said& said : all) {
        std::string text = printable(said.text);
        const auto found = std::ranges::find(entries_, text, &Entry::text);
        if (found != entries_.end() && !found->sources.empty()) {
            if (std::ranges::count(found->sources, source) == 0) found->sources.emplace_back(source);
            continue;
        }
        Entry entry{.severity = said.severity, .text = std::move(text), .sources = {std::string(source)}};
        if (found != entries_.end()) {
            entry.count = found->count + 1;
            entries_.erase(found);
        }
        ++version_;
        new_.push_back({entry.severity, entry.text});
        entries_.push_back(std::move(entry));
    }
    auto present = static_cast<std::size_t>(
        std::ranges::count_if(entries_, [](const Entry& entry) { return !entry.sources.empty(); }));
    for (Entry& entry : entries_)
        if (present > max_present && !entry.sources.empty()) {
            entry.sources.clear();
            --present;
        }
    while (entries_.size() > max_kept) entries_.pop_front();
}

void Messages::report(std::string_view source, const Error& error) {
    const Said said{Severity::Error, error.text};
    say(source, {&said, 1});
}

bool Messages::settle(std::string_view source, const Result<>& result) {
    if (result)
        clear(source);
    else
        report(source, result.error());
    return result.has_value();
}

void Messages::note(std::string_view text) {
    const std::string line = printable(text);
    ++version_;
    if (!entries_.empty() && entries_.back().text == line) {
        ++entries_.back().count;
        return;
    }
    entries_.push_back({.severity = Severity::Info, .text = line});
    while (entries_.size() > max_kept) entries_.pop_front();
}

bool Messages::is_empty() const { return std::ranges::none_of(entries_, is_shown); }

std::vector<std::string> Messages::texts() const {
    std::vector<std::string> out;
    for (const Entry& entry : entries_)
        if (is_shown(entry)) out.push_back(entry.text);
    return out;
}

std::size_t Messages::count(Severity severity) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        entries_, [&](const Entry& entry) { return !entry.sources.empty() && entry.severity == severity; }));
}

std::optional<TextPlace> Messages::file_of(const Entry& entry) const {
    std::optional<TextPlace> place = place_in(entry.text);
    if (!place) return place;
    std::error_code error;
    for (const std::filesystem::path& file : {place->file, folder_ / place->file})
        if (std::filesystem::is_regular_file(file, error)) {
            place->file = std::filesystem::absolute(file, error);
            return place;
        }
    return std::nullopt;
}

void Messages::offer_place(const Entry& entry) {
    if (!ImGui::IsItemHovered()) return;
    const std::optional<TextPlace> place = file_of(entry);
    if (!place) return;
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    tooltip(fmt::format("Opens {} at line {}.", printable(place->file.filename().string()), place->line).c_str());
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) chosen_ = place;
}

float Messages::height(float width) const {
    float sum = 0;
    for (const Entry& entry : entries_)
        if (is_shown(entry)) sum += text_height(shown(entry), width) + ImGui::GetStyle().ItemSpacing.y;
    return sum;
}

void Messages::draw(const Note& note) {
    const float width = ImGui::GetContentRegionAvail().x;
    const float pad = ImGui::GetStyle().FramePadding.y, gap = ImGui::GetStyle().ItemSpacing.x;
    int number = 0;
    for (Entry& entry : entries_) {
        if (!is_shown(entry)) continue;
        const std::string text = shown(entry);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float height = text_height(text, width);
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const ImVec2 end{corner.x + width, corner.y + height};
        list.AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
        list.AddRectFilled(corner, {corner.x + gap / 2, end.y}, color_of(entry.severity));
        ImGui::PushID(number);
        ImGui::SetCursorScreenPos({corner.x + 1.5f * gap, corner.y + pad});
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + text_width(width));
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        if (note) note(fmt::format("message/{}", number));
        offer_place(entry);
        ImGui::SetCursorScreenPos({end.x - ImGui::GetFrameHeight(), corner.y});
        if (icon_button("##close", Icon::Remove, "Removes this message.")) entry.is_put_away = true;
        ImGui::SetCursorScreenPos(corner);
        ImGui::Dummy({width, height});
        ImGui::PopID();
        ++number;
    }
}

void Messages::draw_history(const Note& note) {
    if (entries_.empty()) return ImGui::TextDisabled("There are no messages.");
    int number = 0;
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry, ++number) {
        const bool is_over = entry->sources.empty();
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetTextLineHeight();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            {corner.x + side / 2, corner.y + side / 2}, side / 4,
            is_over ? ImGui::GetColorU32(ImGuiCol_TextDisabled) : color_of(entry->severity));
        ImGui::SetCursorScreenPos({corner.x + 1.5f * side, corner.y});
        ImGui::PushTextWrapPos(0);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(is_over ? ImGuiCol_TextDisabled : ImGuiCol_Text));
        ImGui::TextUnformatted(shown(*entry).c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        if (note) note(fmt::format("history/{}", number));
        offer_place(*entry);
    }
}

}  // namespace darkroom::panels
