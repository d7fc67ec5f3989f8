// SPDX-License-Identifier: MIT
#include "panels/show/timings.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "panels/widgets/plot.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

/// Of an even number the upper one of the two in the middle.
TimingHistory::Statistics statistics(std::vector<float> values) {
    if (values.empty()) return {};
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return {.median = *middle, .worst = *std::ranges::max_element(values)};
}

float number(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0f; }

}  // namespace

void TimingHistory::add(const RecordingTimes& times, double record_microseconds) {
    if (times.passes.empty()) return;
    if (!frames_.empty() && frames_.back().frame_index == times.frame_index) return;
    Frame frame{.frame_index = times.frame_index, .record_microseconds = number(record_microseconds)};
    for (const PassTime& pass : times.passes) {
        const float milliseconds = number(pass.milliseconds);
        frame.milliseconds += milliseconds;
        if (frame.passes.size() < max_passes)
            frame.passes.push_back({.name = index_of(pass.name), .milliseconds = milliseconds});
        else
            frame.passes.back().milliseconds += milliseconds;
    }
    frames_.push_back(std::move(frame));
    if (frames_.size() > max_frames) frames_.pop_front();
    if (names_.size() > 2 * max_passes) drop_unused_names();
}

std::uint32_t TimingHistory::index_of(std::string_view name) {
    const auto index = std::ranges::find(names_, name) - names_.begin();
    if (index == std::ssize(names_)) names_.emplace_back(name);
    return static_cast<std::uint32_t>(index);
}

void TimingHistory::drop_unused_names() {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> index(names_.size(), unused);
    std::vector<std::string> kept;
    for (Frame& frame : frames_)
        for (Pass& pass : frame.passes) {
            if (index[pass.name] == unused) {
                index[pass.name] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(std::move(names_[pass.name]));
            }
            pass.name = index[pass.name];
        }
    names_ = std::move(kept);
}

TimingHistory::Statistics TimingHistory::of_frames() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.milliseconds);
    return statistics(std::move(values));
}

float TimingHistory::max_shown() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.milliseconds);
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return std::min(1.5f * values[(values.size() - 1) * 9 / 10], 1.05f * values.back());
}

TimingHistory::Statistics TimingHistory::of_recording() const {
    std::vector<float> values;
    for (const Frame& frame : frames_) values.push_back(frame.record_microseconds);
    return statistics(std::move(values));
}

TimingHistory::Statistics TimingHistory::of_pass(std::uint32_t name) const {
    std::vector<float> values;
    for (const Frame& frame : frames_)
        for (const Pass& pass : frame.passes)
            if (pass.name == name) values.push_back(pass.milliseconds);
    return statistics(std::move(values));
}

namespace {

/// The smallest of 1, 2 and 5 times a power of ten that goes no more than four times into `range`.
float grid_step(float range) {
    const float power = std::pow(10.0f, std::floor(std::log10(range / 4)));
    for (const float factor : {1.0f, 2.0f, 5.0f})
        if (power * factor * 4 >= range) return power * factor;
    return power * 10;
}

double shown(float value) { return static_cast<double>(value); }

double percent(float part, float whole) { return whole > 0 ? 100.0 * shown(part) / shown(whole) : 0; }

void pass_tooltip(const TimingHistory& history, const TimingHistory::Pass& pass, float whole) {
    const TimingHistory::Statistics statistics = history.of_pass(pass.name);
    ImGui::SetTooltip("%s\n%.3f ms, %.1f %%\nmedian %.3f ms, worst %.3f ms", history.name(pass.name).c_str(),
                      shown(pass.milliseconds), percent(pass.milliseconds, whole), shown(statistics.median),
                      shown(statistics.worst));
}

/// As much of a name as there is room for, if that says anything.
void label(const Plot& plot, float left, float right, const std::string& name) {
    const ImVec2 corner = plot.at(left, 1), end = plot.at(right, 0);
    const float font = ImGui::GetFontSize();
    if (end.x - corner.x < std::min(ImGui::CalcTextSize(name.c_str()).x + 8, 4 * font)) return;
    plot.list->PushClipRect(corner, {end.x - 4, end.y}, true);
    plot.list->AddText({corner.x + 4, (corner.y + end.y - font) / 2}, IM_COL32(16, 16, 16, 255), name.c_str());
    plot.list->PopClipRect();
}

void draw_grid(const Plot& plot, float most) {
    const float step = grid_step(most);
    for (int i = 1; static_cast<float>(i) * step < most; ++i) {
        const float value = static_cast<float>(i) * step;
        plot.horizontal(value / most, grid_color());
        const ImVec2 place = plot.at(0, value / most);
        const std::string text = fmt::format("{:g} ms", value);
        if (place.y - ImGui::GetFontSize() > plot.min.y)
            plot.list->AddText({place.x + 4, place.y - ImGui::GetFontSize()}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                               text.c_str());
    }
}

}  // namespace

std::uint32_t TimingsPanel::color_of(std::uint32_t name) const {
    return faded(series_color(name), pointed_ == none || pointed_ == name ? 1.0f : 0.3f);
}

void TimingsPanel::draw_bar(const TimingHistory& history) {
    const TimingHistory::Frame& frame = history.frames().back();
    const Plot plot = begin_plot("bar", {ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()});
    const float pixel = 1 / (plot.max.x - plot.min.x);
    const TimingHistory::Pass* under_mouse = nullptr;
    const float whole = std::max(frame.milliseconds, 1e-6f);
    float sum = 0;
    for (const TimingHistory::Pass& pass : frame.passes) {
        const float left = sum / whole;
        sum += pass.milliseconds;
        const float right = sum / whole;
        plot.fill(left, 0, std::max(right - pixel, left + pixel / 2), 1, color_of(pass.name));
        label(plot, left, right, history.name(pass.name));
        if (plot.is_hovered && plot.mouse.x >= left && plot.mouse.x < right) under_mouse = &pass;
    }
    end_plot(plot);
    if (under_mouse == nullptr) return;
    next_pointed_ = under_mouse->name;
    pass_tooltip(history, *under_mouse, frame.milliseconds);
}

void TimingsPanel::draw_column(const Plot& plot, const TimingHistory::Frame& frame, float number, float most) const {
    // More rectangles in one list are too many for indices of 16 bits, which hosts may have.
    constexpr std::size_t max_parts = 50;
    const float least = frame.passes.size() > max_parts ? 1.0f / max_parts : 1 / (plot.max.y - plot.min.y);
    float drawn = 0, sum = 0;
    for (const TimingHistory::Pass& pass : frame.passes) {
        sum += pass.milliseconds / most;
        // What is too thin to be seen goes to the next one.
        if (sum - drawn < least && &pass != &frame.passes.back()) continue;
        plot.fill(number / TimingHistory::max_frames, drawn, (number + 1) / TimingHistory::max_frames, sum,
                  color_of(pass.name));
        drawn = sum;
    }
}

void TimingsPanel::draw_history(const TimingHistory& history, float height) {
    const Plot plot = begin_plot("history", {ImGui::GetContentRegionAvail().x, height});
    const float most = std::max(history.max_shown(), 1e-3f);
    // The newest at the right.
    std::size_t column = TimingHistory::max_frames - history.frames().size();
    const auto column_under_mouse = static_cast<std::size_t>(std::max(plot.mouse.x, 0.0f) * TimingHistory::max_frames);
    const TimingHistory::Frame* under_mouse = nullptr;
    for (const TimingHistory::Frame& frame : history.frames()) {
        draw_column(plot, frame, static_cast<float>(column), most);
        if (frame.milliseconds > most) {
            const float left = static_cast<float>(column) / TimingHistory::max_frames;
            const float top = 3 / (plot.max.y - plot.min.y);
            plot.fill(left, 1 - top, left + 1.0f / TimingHistory::max_frames, 1, ImGui::GetColorU32(accent_color));
        }
        if (plot.is_hovered && column == column_under_mouse) under_mouse = &frame;
        ++column;
    }
    draw_grid(plot, most);
    if (under_mouse != nullptr) plot.vertical(plot.mouse.x, ImGui::GetColorU32(ImGuiCol_Text, 0.5f));
    end_plot(plot);
    if (under_mouse != nullptr) history_tooltip(history, *under_mouse, plot.mouse.y * most);
}

void TimingsPanel::history_tooltip(const TimingHistory& history, const TimingHistory::Frame& frame, float place) {
    std::string text;
    float sum = 0;
    for (const TimingHistory::Pass& pass : frame.passes) {
        sum += pass.milliseconds;
        if (sum < place) continue;
        next_pointed_ = pass.name;
        text = fmt::format("{}: {:.3f} ms\n", history.name(pass.name), pass.milliseconds);
        break;
    }
    text += fmt::format("frame {}: {:.3f} ms, recorded in {:.0f} us", frame.frame_index, frame.milliseconds,
                        frame.record_microseconds);
    ImGui::SetTooltip("%s", text.c_str());
}

void TimingsPanel::draw_table(const TimingHistory& history) {
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit;
    const bool is_wide = ImGui::GetContentRegionAvail().x > 26 * ImGui::GetFontSize();
    if (!ImGui::BeginTable("passes", is_wide ? 5 : 3, flags, ImGui::GetContentRegionAvail())) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("ms");
    if (is_wide) ImGui::TableSetupColumn("median");
    ImGui::TableSetupColumn("worst");
    if (is_wide) ImGui::TableSetupColumn("share");
    ImGui::TableHeadersRow();
    const TimingHistory::Frame& frame = history.frames().back();
    const auto cell = [](const char* format, double value) {
        ImGui::TableNextColumn();
        ImGui::Text(format, value);
    };
    const auto row = [&](int number) {
        const TimingHistory::Pass& pass = frame.passes[static_cast<std::size_t>(number)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::PushID(number);
        draw_name(history, pass, frame.milliseconds);
        ImGui::PopID();
        const TimingHistory::Statistics statistics = history.of_pass(pass.name);
        cell("%.3f", shown(pass.milliseconds));
        if (is_wide) cell("%.3f", shown(statistics.median));
        cell("%.3f", shown(statistics.worst));
        if (is_wide) cell("%.1f %%", percent(pass.milliseconds, frame.milliseconds));
    };
    ImGuiListClipper visible;
    visible.Begin(static_cast<int>(frame.passes.size()));
    while (visible.Step())
        for (int number = visible.DisplayStart; number < visible.DisplayEnd; ++number) row(number);
    ImGui::EndTable();
}

void TimingsPanel::draw_name(const TimingHistory& history, const TimingHistory::Pass& pass, float whole) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight(), right = corner.x + ImGui::GetContentRegionAvail().x;
    ImGui::Selectable("##row", pointed_ == pass.name, ImGuiSelectableFlags_SpanAllColumns);
    if (ImGui::IsItemHovered()) {
        next_pointed_ = pass.name;
        pass_tooltip(history, pass, whole);
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, corner.y + side * 0.2f}, {corner.x + side * 0.6f, corner.y + side * 0.8f},
                       series_color(pass.name));
    list.PushClipRect(corner, {right, corner.y + side * 1.2f}, true);
    list.AddText({corner.x + side * 0.9f, corner.y}, ImGui::GetColorU32(ImGuiCol_Text),
                 history.name(pass.name).c_str());
    list.PopClipRect();
}

void TimingsPanel::draw(const TimingHistory& history) {
    if (history.frames().empty()) {
        ImGui::TextDisabled("No times yet.");
        return;
    }
    next_pointed_ = none;
    const TimingHistory::Statistics gpu = history.of_frames(), cpu = history.of_recording();
    ImGui::Text("GPU %.2f ms", shown(gpu.median));
    ImGui::SameLine();
    ImGui::TextDisabled("worst %.2f", shown(gpu.worst));
    if (ImGui::GetContentRegionAvail().x > 22 * ImGui::GetFontSize()) ImGui::SameLine();
    ImGui::Text("record %.0f us", shown(cpu.median));
    ImGui::SameLine();
    ImGui::TextDisabled("worst %.0f", shown(cpu.worst));
    draw_bar(history);
    const float rest = ImGui::GetContentRegionAvail().y, line = ImGui::GetTextLineHeightWithSpacing();
    const bool has_table = rest > 9 * line;
    draw_history(history, has_table ? std::max(rest * 0.4f, 4 * line) : std::max(rest, 4 * line));
    if (has_table) draw_table(history);
    pointed_ = next_pointed_;
}

}  // namespace darkroom::panels
