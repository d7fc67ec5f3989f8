// SPDX-License-Identifier: MIT
#include "panels/show/plan_picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "panels/panel_state.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/plot.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

using Kind = PlanImage::Kind;

constexpr std::uint32_t none = ~0u;
/// Lower bars could not be pointed at.
constexpr float least_bar_height = 3;
constexpr float memory_rows = 5;

bool is_used(const PlanImage& image) { return image.first_pass != PlanImage::never; }

bool writes(const PlanPass& pass, std::uint32_t image) { return pass.writes.image == image; }
bool reads(const PlanPass& pass, std::uint32_t image) {
    return std::ranges::find(pass.reads, image, &PlanUse::image) != pass.reads.end();
}

/// "bloom" and "upsample 1" of "bloom.upsample 1"; a pass that is all of its effects has no part.
std::string title_of(const PlanPass& pass) { return pass.name.substr(0, pass.name.find('.')); }
std::string part_of(const PlanPass& pass) {
    const std::size_t end = pass.name.find('.');
    return end == std::string::npos ? std::string() : pass.name.substr(end + 1);
}

/// Images have the colour of the pass that makes them first.
std::uint32_t maker(const Plan& plan, std::uint32_t image) {
    const auto pass = std::ranges::find_if(plan.passes, [&](const PlanPass& each) { return writes(each, image); });
    return pass == plan.passes.end() ? none : static_cast<std::uint32_t>(pass - plan.passes.begin());
}

/// Of each pass, which effect's it is, counted along the frame. Passes of several may take turns.
std::vector<std::uint32_t> effects_of(const Plan& plan) {
    std::vector<std::string> titles;
    std::vector<std::uint32_t> out;
    for (const PlanPass& pass : plan.passes) {
        const auto found = std::ranges::find(titles, title_of(pass));
        out.push_back(static_cast<std::uint32_t>(found - titles.begin()));
        if (found == titles.end()) titles.push_back(title_of(pass));
    }
    return out;
}

/// What stands over a pass alone: its part, or its effect where it is all of it.
std::string own_name(const PlanPass& pass) { return part_of(pass).empty() ? title_of(pass) : part_of(pass); }

/// Broken where words end, so that every line fits into the width; else nothing.
std::vector<std::string> lines_of(const std::string& text, float width) {
    std::vector<std::string> out{""};
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find_first_of("+ ", begin), text.size() - 1) + 1;
        const std::string word = text.substr(begin, end - begin);
        if (ImGui::CalcTextSize(word.c_str()).x > width) return {};
        if (!out.back().empty() && ImGui::CalcTextSize((out.back() + word).c_str()).x > width) out.emplace_back();
        out.back() += word;
        begin = end;
    }
    return out;
}

/// What a name takes above its column: lines, or one along the column.
float height_of_name(const std::string& name, float column) {
    const std::vector<std::string> lines = lines_of(name, column - 6);
    return lines.empty() ? ImGui::CalcTextSize(name.c_str()).x + 6
                         : static_cast<float>(lines.size()) * ImGui::GetFontSize() + 4;
}

std::string byte_text(std::uint64_t bytes) {
    if (bytes < 1024) return fmt::format("{} B", bytes);
    const double kibibytes = static_cast<double>(bytes) / 1024;
    if (kibibytes < 1024) return fmt::format("{:.1f} KiB", kibibytes);
    return fmt::format("{:.1f} MiB", kibibytes / 1024);
}

/// What is under the mouse.
struct Pointed {
    std::uint32_t image = none, pass = none;
};

class Picture {
  public:
    Picture(const Plan& plan, const PlanLayout& layout, const Plot& plot)
        : plan_(plan), layout_(layout), plot_(plot), effects_(effects_of(plan)), pointed_(find()) {}

    void draw() const {
        draw_titles();
        draw_columns();
        for (const PlanLayout::Bar& bar : layout_.bars) draw_bar(bar);
        if (pointed_.image != none) draw_users(pointed_.image);
    }

    void tooltip() const {
        if (pointed_.image != none)
            ImGui::SetTooltip("%s", image_text(pointed_.image).c_str());
        else if (pointed_.pass != none)
            ImGui::SetTooltip("%s", pass_text(plan_.passes[pointed_.pass]).c_str());
    }

  private:
    [[nodiscard]] ImVec2 place(ImVec2 in_picture) const {
        return {plot_.min.x + in_picture.x, plot_.min.y + in_picture.y};
    }

    [[nodiscard]] Pointed find() const {
        if (!plot_.is_hovered) return {};
        const ImVec2 mouse{ImGui::GetMousePos().x - plot_.min.x, ImGui::GetMousePos().y - plot_.min.y};
        Pointed found;
        float least = 0;
        for (const PlanLayout::Bar& bar : layout_.bars) {
            const bool is_inside =
                mouse.x >= bar.min.x && mouse.x < bar.max.x && mouse.y >= bar.min.y && mouse.y < bar.max.y;
            const float height = bar.max.y - bar.min.y;
            // Low bars are made higher than they are, and lie over others.
            if (!is_inside || (found.image != none && height >= least)) continue;
            found.image = bar.image;
            least = height;
        }
        const auto column = static_cast<std::size_t>(mouse.x / layout_.column_width);
        if (found.image == none && column < plan_.passes.size()) found.pass = static_cast<std::uint32_t>(column);
        return found;
    }

    [[nodiscard]] bool is_bound_to_pointed(std::uint32_t image) const {
        if (pointed_.image != none) return image == pointed_.image;
        if (pointed_.pass == none) return true;
        const PlanPass& pass = plan_.passes[pointed_.pass];
        return writes(pass, image) || reads(pass, image);
    }

    /// One over all neighbours that share it: a column of its own would be too narrow for most.
    void draw_titles() const {
        for (std::size_t first = 0, end = 0; first < plan_.passes.size(); first = end) {
            const std::string title = title_of(plan_.passes[first]);
            while (end < plan_.passes.size() && title_of(plan_.passes[end]) == title) ++end;
            const ImVec2 min{static_cast<float>(first) * layout_.column_width, 0};
            if (end == first + 1 && part_of(plan_.passes[first]).empty()) continue;  // its column says it
            const ImVec2 max{static_cast<float>(end) * layout_.column_width - 1, layout_.title_height};
            plot_.list->AddRectFilled(place(min), place({max.x, max.y - 1}), ImGui::GetColorU32(ImGuiCol_Header));
            label(title, min, max, ImGui::GetColorU32(ImGuiCol_Text));
        }
    }

    void draw_columns() const {
        for (std::uint32_t i = 0; i < plan_.passes.size(); ++i) {
            const float left = static_cast<float>(i) * layout_.column_width, right = left + layout_.column_width;
            const float top = part_of(plan_.passes[i]).empty() ? 0 : layout_.title_height;
            const bool is_bound = pointed_.image == none ? pointed_.pass == none || pointed_.pass == i
                                                         : writes(plan_.passes[i], pointed_.image) ||
                                                               reads(plan_.passes[i], pointed_.image);
            plot_.list->AddRectFilled(place({left, top}), place({right - 1, layout_.header_height - 1}),
                                      faded(series_color(effects_[i]), is_bound ? 1.0f : 0.3f));
            if (pointed_.pass == i)
                plot_.list->AddRectFilled(place({left, layout_.header_height}), place({right - 1, layout_.size.y}),
                                          ImGui::GetColorU32(ImGuiCol_Text, 0.06f));
            plot_.list->AddLine(place({right - 0.5f, layout_.header_height}), place({right - 0.5f, layout_.size.y}),
                                grid_color());
            head(own_name(plan_.passes[i]), {left, top}, {right - 1, layout_.header_height});
        }
        plot_.list->AddLine(place({0, layout_.memory_top - 2}), place({layout_.size.x, layout_.memory_top - 2}),
                            ImGui::GetColorU32(ImGuiCol_Border));
    }

    void draw_bar(const PlanLayout::Bar& bar) const {
        const PlanImage& image = plan_.images[bar.image];
        const std::uint32_t made_by = maker(plan_, bar.image);
        const ImU32 base =
            made_by == none ? ImGui::GetColorU32(ImGuiCol_TextDisabled) : series_color(effects_[made_by]);
        const bool is_bound = is_bound_to_pointed(bar.image);
        const ImVec2 min = place(bar.min), max = place({bar.max.x - 1, bar.max.y - 1});
        if (image.kind == Kind::History) {
            // It was there before the first pass and is after the last.
            const float middle = (min.y + max.y) / 2;
            plot_.list->AddLine({plot_.min.x, middle}, {plot_.max.x, middle}, faded(base, is_bound ? 0.6f : 0.2f), 2);
        }
        plot_.list->AddRectFilled(min, max, faded(base, is_bound ? 0.5f : 0.15f));
        label(image.name, bar.min, bar.max, ImGui::GetColorU32(ImGuiCol_Text, is_bound ? 1.0f : 0.4f));
    }

    /// In the columns of those who write the image, a full mark; of those who read it, an open one.
    void draw_users(std::uint32_t image) const {
        const auto bar = std::ranges::find(layout_.bars, image, &PlanLayout::Bar::image);
        const ImU32 color = ImGui::ColorConvertFloat4ToU32(accent_color);
        plot_.list->AddRect(place(bar->min), place({bar->max.x - 1, bar->max.y - 1}), color);
        const float radius = std::min(layout_.column_width, layout_.title_height) * 0.27f;
        for (std::uint32_t i = 0; i < plan_.passes.size(); ++i) {
            const ImVec2 middle =
                place({(static_cast<float>(i) + 0.5f) * layout_.column_width, layout_.header_height + radius * 1.5f});
            const bool is_writer = writes(plan_.passes[i], image), is_reader = reads(plan_.passes[i], image);
            if (!is_writer && !is_reader) continue;
            plot_.list->AddLine(middle, {middle.x, plot_.min.y + bar->min.y}, faded(color, 0.6f));
            if (is_writer) plot_.list->AddCircleFilled(middle, radius, color);
            if (is_reader) plot_.list->AddCircle(middle, radius, color, 0, 2);
        }
    }

    void label(const std::string& text, ImVec2 min, ImVec2 max, ImU32 color) const {
        const float font = ImGui::GetFontSize();
        if (max.y - min.y < font * 0.9f || max.x - min.x < 2 * font) return;
        const ImVec2 corner = place(min), end = place({max.x - 3, max.y});
        plot_.list->PushClipRect(corner, end, true);
        plot_.list->AddText({corner.x + 3, (corner.y + end.y - font) / 2}, color, text.c_str());
        plot_.list->PopClipRect();
    }

    /// Along the column where it is wider than that.
    void head(const std::string& text, ImVec2 min, ImVec2 max) const {
        constexpr ImU32 dark = IM_COL32(16, 16, 16, 255);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        if (size.x + 6 <= max.x - min.x)
            return label(text, min, {max.x, std::min(max.y, min.y + 1.25f * size.y)}, dark);
        const ImVec2 corner = place(min), end = place(max);
        const std::vector<std::string> lines = lines_of(text, max.x - min.x - 5);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const float top =
                std::min((corner.y + end.y - static_cast<float>(lines.size()) * size.y) / 2, corner.y + 3);
            plot_.list->AddText({corner.x + 3, top + static_cast<float>(i) * size.y}, dark, lines[i].c_str());
        }
        if (!lines.empty() || end.x - corner.x < size.y * 0.8f) return;
        // Written where nothing cuts it off, then turned by a quarter, so that it reads upwards and ends at the top,
        // which is in view where the longest name is not.
        const ImVec2 from = place({0, 0});
        const int first = plot_.list->VtxBuffer.Size;
        plot_.list->AddText(from, dark, text.c_str());
        const float bottom = std::min(end.y, corner.y + size.x + 6) - 3;
        const float left = std::round((corner.x + end.x - size.y) / 2);
        for (int i = first; i < plot_.list->VtxBuffer.Size; ++i) {
            ImVec2& at = plot_.list->VtxBuffer[i].pos;
            at = {left + (at.y - from.y), bottom - (at.x - from.x)};
        }
    }

    [[nodiscard]] std::string image_text(std::uint32_t index) const {
        const PlanImage& image = plan_.images[index];
        std::string text = fmt::format("{}\n{} x {}", image.name, image.extent.width, image.extent.height);
        if (image.mip_levels > 1) text += fmt::format(", {} levels", image.mip_levels);
        if (image.kind == Kind::Host) text += ", of the host";
        if (image.kind == Kind::Transient)
            text += fmt::format(", {} at {}", byte_text(image.bytes), byte_text(image.offset));
        if (image.kind == Kind::History) text += fmt::format(", two of {}", byte_text(image.bytes));
        for (const PlanPass& pass : plan_.passes)
            if (writes(pass, index)) text += "\nwritten by " + pass.name;
        for (const PlanPass& pass : plan_.passes)
            if (reads(pass, index)) text += "\nread by " + pass.name;
        return text;
    }

    [[nodiscard]] static std::string pass_text(const PlanPass& pass) {
        std::string text = fmt::format("{}\n{}, {} x {}\nreads {}, writes {}", pass.name, pass.stage, pass.extent.width,
                                       pass.extent.height, byte_text(pass.bytes_read), byte_text(pass.bytes_written));
        if (!pass.boundary.empty()) text += "\n" + pass.boundary;
        for (const std::string& entry : pass.entries) text += "\n  " + entry;
        return text;
    }

    const Plan& plan_;
    const PlanLayout& layout_;
    const Plot& plot_;
    std::vector<std::uint32_t> effects_;
    Pointed pointed_;
};

}  // namespace

PlanLayout lay_out(const Plan& plan, ImVec2 size, float row, float names) {
    PlanLayout layout{.title_height = row, .header_height = row + std::max(row, names)};
    layout.column_width = size.x / static_cast<float>(std::max<std::size_t>(plan.passes.size(), 1));
    float top = layout.header_height + 2;
    const auto add = [&](std::uint32_t index, float from, float height) {
        const PlanImage& image = plan.images[index];
        layout.bars.push_back({index,
                               {static_cast<float>(image.first_pass) * layout.column_width, from},
                               {static_cast<float>(image.last_pass + 1) * layout.column_width, from + height}});
    };
    for (const Kind kind : {Kind::Host, Kind::History})
        for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
            if (plan.images[i].kind != kind || !is_used(plan.images[i])) continue;
            add(i, top, row);
            top += row;
        }
    layout.memory_top = top + 4;
    layout.size = {size.x, std::max(size.y, layout.memory_top + memory_rows * row)};
    const double scale = static_cast<double>(layout.size.y - layout.memory_top) /
                         static_cast<double>(std::max<std::uint64_t>(plan.transient_bytes, 1));
    for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
        const PlanImage& image = plan.images[i];
        if (image.kind != Kind::Transient || !is_used(image)) continue;
        const float height = std::max(static_cast<float>(static_cast<double>(image.bytes) * scale), least_bar_height);
        const float from = layout.memory_top + static_cast<float>(static_cast<double>(image.offset) * scale);
        add(i, std::min(from, layout.size.y - height), height);
    }
    return layout;
}

namespace {

/// 0: each has room in its column.
float height_of_names(const Plan& plan, float width) {
    const float column = width / static_cast<float>(std::max<std::size_t>(plan.passes.size(), 1));
    if (column < ImGui::GetFontSize() * 0.8f) return 0;
    float highest = 0;
    for (const PlanPass& pass : plan.passes) {
        const float height = height_of_name(own_name(pass), column);
        highest = std::max(highest, part_of(pass).empty() ? height - 1.25f * ImGui::GetFontSize() : height);
    }
    return highest;
}

}  // namespace

void draw_plan_picture(const Plan& plan) {
    std::string text =
        fmt::format("{} pass{}, {} of images in {}", plan.passes.size(), plan.passes.size() == 1 ? "" : "es",
                    byte_text(plan.transient_bytes_unaliased), byte_text(plan.transient_bytes));
    if (!plan.left_out.empty()) text += fmt::format(", left out: {}", plan.left_out.size());
    ImGui::TextUnformatted(text.c_str());
    if (ImGui::BeginChild("picture")) {
        const ImVec2 room = ImGui::GetContentRegionAvail();
        const float row = std::round(1.25f * ImGui::GetFontSize());
        const float width = std::max(room.x, 1.0f);
        const PlanLayout layout = lay_out(plan, {width, room.y}, row, height_of_names(plan, width));
        const Plot plot = begin_plot("plan", layout.size);
        const Picture picture(plan, layout, plot);
        picture.draw();
        end_plot(plot);
        picture.tooltip();
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
        for (const std::string& each : plan.left_out) ImGui::TextWrapped("left out: %s", each.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::EndChild();
}

namespace {

std::string bytes_text(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

/// Names of fused kernels get places for line breaks.
std::string breakable(const std::string& name) {
    std::string out;
    for (const char letter : name) out += letter == '+' ? " + " : std::string(1, letter);
    return out;
}

void draw_pass(const PlanPass& pass, std::size_t number) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%zu", number);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(breakable(pass.name).c_str());
    ImGui::PopTextWrapPos();
    tooltip(fmt::format("{}\nHolds: {} ({})\n{} read, {} written", pass.boundary, fmt::join(pass.entries, ", "),
                        pass.stage, bytes_text(pass.bytes_read), bytes_text(pass.bytes_written))
                .c_str());
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%ux%u", pass.extent.width, pass.extent.height);
}

void draw_sentences(const char* heading, const std::vector<std::string>& sentences) {
    if (sentences.empty()) return;
    ImGui::Spacing();
    ImGui::TextDisabled("%s", heading);
    ImGui::PushTextWrapPos(0);
    for (const std::string& sentence : sentences) ImGui::TextUnformatted(sentence.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void draw_plan_panel(const Plan* plan, bool is_compiling) {
    if (plan == nullptr) {
        ImGui::TextDisabled("%s", is_compiling ? "Compiling..." : "There is no plan yet.");
        return;
    }
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(fmt::format("{} pass{}, {} of images{}", plan->passes.size(),
                                       plan->passes.size() == 1 ? "" : "es", bytes_text(plan->transient_bytes),
                                       is_compiling ? ", compiling..." : "")
                               .c_str());
    ImGui::PopTextWrapPos();
    tooltip(fmt::format("Without sharing memory they would take {}. A frame reads {} and writes {}.",
                        bytes_text(plan->transient_bytes_unaliased), bytes_text(plan->bytes_read()),
                        bytes_text(plan->bytes_written()))
                .c_str());
    if (ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
        ImGui::TableSetupColumn("number");
        ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
        ImGui::TableSetupColumn("extent");
        for (std::size_t i = 0; i < plan->passes.size(); ++i) draw_pass(plan->passes[i], i + 1);
        ImGui::EndTable();
    }
    draw_sentences("Left out", plan->left_out);
    draw_sentences("Misplaced", plan->misplaced);
    draw_sentences("Remarks", plan->remarks);
}

}  // namespace darkroom::panels
