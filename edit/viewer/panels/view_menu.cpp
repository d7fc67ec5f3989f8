// SPDX-License-Identifier: MIT
// The bar above the panels, what closes them and brings them back, and the lines between them.
#include <algorithm>
#include <array>

#include "formats/file_format.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/theme.hpp"
#include "viewer/panels/areas.hpp"
#include "viewer/panels/edit_panels.hpp"

namespace app {

namespace {

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr const char* view_text = "View";
constexpr const char* open_text = "Open...";

float button_width(const char* text) { return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x; }
ImVec2 corner_of(const VkRect2D& area) {
    return {static_cast<float>(area.offset.x), static_cast<float>(area.offset.y)};
}
ImVec2 size_of(const VkRect2D& area) {
    return {static_cast<float>(area.extent.width), static_cast<float>(area.extent.height)};
}

}  // namespace

void begin_area(const char* name, const VkRect2D& area, ImGuiWindowFlags more) {
    ImGui::SetNextWindowPos(corner_of(area));
    ImGui::SetNextWindowSize(size_of(area));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin(name, nullptr, fixed | more);
    ImGui::PopStyleVar();
}

void tip(const char* text) { darkroom::panels::tooltip(text); }

float checkbox_width(const char* label) {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(label).x;
}

void Flow::next(float width) {
    const float end = rows_ == 0 ? 0 : ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width;
    const float room = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (rows_ > 0 && end <= room)
        ImGui::SameLine();
    else
        ++rows_;
}

void EditPanels::draw_bar() {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float buttons = button_width(view_text) + button_width(open_text) + 2 * gap;
    // The file's name ends where the buttons begin.
    ImGui::BeginChild("##look", {std::max(ImGui::GetContentRegionAvail().x - buttons, 1.0F), ImGui::GetFrameHeight()},
                      false, ImGuiWindowFlags_NoScrollbar);
    look_.draw_bar();
    ImGui::EndChild();
    ImGui::SameLine();
    draw_view_menu();
    ImGui::SameLine();
    draw_open_button();
}

void EditPanels::draw_view_menu() {
    constexpr const char* popup = "##view menu";
    if (ImGui::Button(view_text)) ImGui::OpenPopup(popup);
    look_.note_place("view/menu");
    tip("Shows and closes panels.");
    if (!ImGui::BeginPopup(popup)) return;
    const auto item = [&](const char* name, bool& is_there) {
        ImGui::MenuItem(name, nullptr, &is_there);
        look_.note_place(std::string("menu/") + name);
    };
    item("Stack", sizes_.has_stack);
    item("Parameters", sizes_.has_entry);
    item("Plan, scopes, messages", sizes_.has_below);
    item("Status line", sizes_.has_status);
    ImGui::Separator();
    if (ImGui::MenuItem("Full screen", "F11", is_over_)) is_fullscreen_wanted_ = true;
    look_.note_place("menu/Full screen");
    if (ImGui::MenuItem("Keys", "?")) is_key_sheet_wanted_ = true;
    look_.note_place("menu/Keys");
    if (ImGui::MenuItem("Put panels back")) sizes_ = {};
    look_.note_place("menu/Put panels back");
    ImGui::EndPopup();
}

void EditPanels::draw_open_button() {
    if (ImGui::Button(open_text)) {
        std::vector<std::string> extensions = darkroom::picture_extensions();
        extensions.insert(extensions.begin(), {".toml", ".glb", ".gltf"});
        look_.files().open({.title = "A scene, a model, a frame or a picture",
                            .extensions = std::move(extensions),
                            .then = [this](const std::filesystem::path& file) { opened_ = file; }});
    }
    look_.note_place("view/open");
    tip("Opens another scene, model, frame or picture to see through the look.");
}

void EditPanels::begin_panel(const char* name, const VkRect2D& area, bool& is_there) {
    begin_area(name, area);
    const float side = ImGui::GetTextLineHeight();
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - side);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
    if (darkroom::panels::icon_button("##close", darkroom::panels::Icon::Remove,
                                      "Closes this panel. View brings it back.", true))
        is_there = false;
    ImGui::PopStyleVar();
    look_.note_place(std::string("close/") + name);
}

void EditPanels::end_panel(const char* name) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    look_.note_place(std::string("panel/") + name, {corner, {corner.x + size.x, corner.y + size.y}});
    ImGui::End();
}

void EditPanels::draw_splitters(const PanelAreas& areas) {
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) dragged_.reset();
    for (std::size_t i = 0; i < splitter_count; ++i)
        if (areas.splitters[i].extent.width > 0) draw_splitter(static_cast<Splitter>(i), areas.splitters[i]);
}

void EditPanels::draw_splitter(Splitter which, const VkRect2D& area) {
    constexpr std::array names{"splitter/Stack", "splitter/Parameters", "splitter/Below", "splitter/Column"};
    const char* const name = names[static_cast<std::size_t>(which)];
    const bool is_upright = which == Splitter::Stack || which == Splitter::Entry;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    begin_area(name, area, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    ImGui::InvisibleButton("##line", size_of(area));
    look_.note_place(name);
    const bool is_held = ImGui::IsItemActive();
    if (is_held || ImGui::IsItemHovered()) {
        ImGui::SetMouseCursor(is_upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        const ImVec2 corner = corner_of(area), size = size_of(area);
        ImGui::GetWindowDrawList()->AddRectFilled(
            corner, {corner.x + size.x, corner.y + size.y},
            ImGui::GetColorU32(is_held ? darkroom::panels::accent_color
                                       : ImGui::GetStyleColorVec4(ImGuiCol_SeparatorHovered)));
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        sizes_ = put_back(sizes_, which);
    } else if (is_held) {
        dragged_ = which;
        // Where it was pressed is no movement yet.
        const ImVec2 mouse = ImGui::GetIO().MousePos, moved_by = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
        if (moved_by.x != 0 || moved_by.y != 0) sizes_ = moved(sizes_, which, mouse.x, mouse.y, room_);
    }
    ImGui::End();
}

}  // namespace app
