// SPDX-License-Identifier: MIT
#include "screen.hpp"

#include <imgui.h>

#include <algorithm>

#include "programs/darkroom/run/report.hpp"
#include "viewer/input/keys.hpp"

namespace app {

namespace {

constexpr double shown_for = 2;  ///< seconds
constexpr std::size_t max_lines = 4, max_printed = 500;
constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

ImVec2 corner_of(const VkRect2D& area) {
    return {static_cast<float>(area.offset.x), static_cast<float>(area.offset.y)};
}
ImVec2 size_of(const VkRect2D& area) {
    return {static_cast<float>(area.extent.width), static_cast<float>(area.extent.height)};
}

}  // namespace

Screen::Screen(darkroom::edit::LookDocument* document) {
    if (document != nullptr) panels_.emplace(*document);
}

VkRect2D Screen::picture_area(VkExtent2D window, float scale, bool has_timeline) const {
    const EditPanels* const shown = panels();
    return shown != nullptr ? shown->layout(window, scale, has_timeline).picture : VkRect2D{{0, 0}, window};
}

void Screen::tell(std::string line) {
    if (!lines_.empty() && lines_.back().text == line) lines_.pop_back();
    messages().note(line);
    last_line_ = line;
    const auto shown = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(shown_for));
    lines_.push_back({std::move(line), now_ + shown_for, Clock::now() + shown});
    is_changed_ = true;
    if (lines_.size() > max_lines) lines_.pop_front();
}

void Screen::say(std::string_view source, std::span<const darkroom::panels::Messages::Said> all) {
    messages().say(source, all);
    print_new();
}

void Screen::tell_error(std::string_view source, std::string line) {
    messages().report(source, darkroom::Error{darkroom::Fault::User, std::move(line)});
    print_new();
}

// Panels report by themselves, too.
void Screen::print_new() {
    for (const darkroom::panels::Messages::Said& said : messages().take_new()) {
        const bool is_warning = said.severity == darkroom::Severity::Warning;
        print(is_warning ? "warning: " + said.text : said.text);
        is_warning ? warn(said.text) : complain(said.text);
        last_line_ = said.text;
    }
}

bool Screen::take_change() {
    const bool is_new = std::exchange(seen_messages_, messages().version()) != messages().version();
    return std::exchange(is_changed_, false) || is_new;
}

bool Screen::is_over() const {
    const Clock::time_point now = Clock::now();
    return std::ranges::any_of(lines_, [&](const Line& line) { return line.over <= now; });
}

void Screen::print(std::string line) {
    is_changed_ = true;
    printed_.push_back(std::move(line));
    if (printed_.size() > max_printed) printed_.pop_front();
}

void Screen::draw(const Input& input) {
    now_ += input.passed;
    const VkRect2D area = picture_area(input.window, input.scale, input.source.frames() > 0);
    if (EditPanels* const shown = panels())
        shown->draw({.source = input.source,
                     .playback = input.playback,
                     .composer = input.view.composer(),
                     .window = input.window,
                     .scale = input.scale,
                     .number = input.number,
                     .is_paused = input.is_paused,
                     .inspection = input.inspection,
                     .watch_state = input.view.watch_state(),
                     .extent = input.extent,
                     .lines = input.lines,
                     .camera = input.camera,
                     .frames_a_second = input.frames_a_second,
                     .last_line = last_line_},
                    picture_);
    draw_picture(input, area);
    draw_errors(input, area);
    if (has_console_) draw_console(area, input.console);
    draw_lines(input, area);
    if (has_key_sheet_) draw_key_sheet(input);
    print_new();
}

void Screen::draw_picture(const Input& input, const VkRect2D& area) {
    PictureView::Shown shown{.first = {.image = input.picture, .transfer = input.transfer},
                             .extent = input.extent,
                             .can_zoom = input.source.extent().has_value()};
    if (input.compared.is_given())
        shown.second = darkroom::window::PaneView{.image = input.compared, .transfer = input.compared_transfer};
    EditPanels* const edit = panels();
    if (panels_ && shown.second) {
        shown.first_name = panels_->name_of(left());
        shown.second_name = panels_->name_of(right());
    }
    if (edit != nullptr) shown.marked = edit->pixel();
    if (input.watched.is_given() && edit != nullptr) {
        shown.first = edit->watched_view();
        shown.first.image = input.watched;
        shown.second.reset();
    }
    picture_.draw(shown, area);
    // A click, and not the end of a drag of the camera.
    const ImVec2 dragged = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    if (edit != nullptr && edit->is_choosing() && picture_.pointed() && !picture_.is_busy() &&
        ImGui::IsMouseReleased(ImGuiMouseButton_Left) && dragged.x * dragged.x + dragged.y * dragged.y < 9)
        edit->choose(*picture_.pointed());
}

void Screen::draw_lines(const Input& input, const VkRect2D& area) {
    std::erase_if(lines_, [&, now = Clock::now()](const Line& line) {
        return input.is_counted ? line.until < now_ : line.over <= now;
    });
    if (lines_.empty()) return;
    const float margin = 12 * input.scale;
    const ImVec2 corner = corner_of(area);
    ImGui::SetNextWindowPos({corner.x + margin, corner.y + size_of(area).y - margin}, ImGuiCond_Always, {0, 1});
    ImGui::Begin("##lines", nullptr, plain | ImGuiWindowFlags_NoInputs);
    for (const Line& line : lines_) ImGui::TextUnformatted(line.text.c_str());
    ImGui::End();
}

void Screen::draw_errors(const Input& input, const VkRect2D& area) {
    if (panels() != nullptr) return;  // they show them
    if (messages().is_empty()) return;
    const float margin = 12 * input.scale;
    const ImVec2 corner = corner_of(area);
    const float width = size_of(area).x - 2 * margin;
    ImGui::SetNextWindowPos({corner.x + margin, corner.y + margin});
    ImGui::SetNextWindowSize({width, messages().height(width - 2 * margin) + 2 * margin});
    ImGui::Begin("##errors", nullptr, plain & ~ImGuiWindowFlags_AlwaysAutoResize);
    messages().draw();
    ImGui::End();
}

// Over everything, with both columns as wide as they must be, and scrolled where a window is small.
void Screen::draw_key_sheet(const Input& input) const {
    const bool is_edit = panels_.has_value();
    const auto width = static_cast<float>(input.window.width), height = static_cast<float>(input.window.height);
    ImGui::SetNextWindowPos({width / 2, height / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({1, 1}, {width * 0.96F, height * 0.96F});
    ImGui::Begin("##keys", nullptr, plain & ~ImGuiWindowFlags_NoScrollbar);
    ImGui::TextDisabled("Keys; ? or Esc closes this list");
    if (ImGui::BeginTable("##lines", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
        for (const KeyLine& line : key_lines()) {
            if (!(is_edit ? line.is_for_edit : line.is_for_play)) continue;
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.shown.c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.doc.data(), line.doc.data() + line.doc.size());
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void Screen::draw_console(const VkRect2D& area, darkroom::Console* console) {
    ImGui::SetNextWindowPos(corner_of(area));
    ImGui::SetNextWindowSize({size_of(area).x, size_of(area).y * 0.5F});
    ImGui::Begin("##console", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::BeginChild("##printed", {0, -ImGui::GetFrameHeightWithSpacing()});
    for (const std::string& text : printed_) ImGui::TextWrapped("%s", text.c_str());
    // Who has scrolled back reads on there, whatever is printed.
    if (ImGui::IsWindowAppearing() || ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
    ImGui::EndChild();
    ImGui::SetNextItemWidth(-1);
    // An open console has the keyboard, also after a click elsewhere, unless somebody types into another widget or
    // chooses from a list.
    const bool has_popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    if (ImGui::IsWindowAppearing() || (!ImGui::IsAnyItemActive() && !has_popup)) ImGui::SetKeyboardFocusHere();
    const auto names = [console](std::string_view begin) {
        return console != nullptr ? console->words(begin) : std::vector<std::string>();
    };
    if (std::optional<std::string> entered = typed_.draw(names, [this](std::string line) { print(std::move(line)); }))
        commands_.push_back(std::move(*entered));
    ImGui::End();
}

}  // namespace app
