// SPDX-License-Identifier: MIT
#include "panels/look/parameter_row.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>

#include "core/text/param_text.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

float mark_width() { return ImGui::GetFontSize() * 0.7f; }

/// Whether the widget stands below the name, because both do not fit in one line.
bool is_tall(const std::string& name, const Columns& columns) {
    return ImGui::CalcTextSize(name.c_str()).x > columns.name_width;
}

/// The name as an item, with the mark before it; the cursor is then where the widget goes.
void draw_name(const std::string& name, const Columns& columns, bool is_marked) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    const bool is_below = is_tall(name, columns);
    const float width = is_below ? ImGui::GetContentRegionAvail().x : mark_width() + columns.name_width;
    ImGui::InvisibleButton("##name", {std::max(1.0f, width), height});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (is_marked)
        list.AddCircleFilled({corner.x + mark_width() * 0.3f, corner.y + height / 2}, ImGui::GetFontSize() * 0.16f,
                             ImGui::GetColorU32(accent_color));
    list.AddText({corner.x + mark_width(), corner.y + ImGui::GetStyle().FramePadding.y},
                 ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
    if (!is_below) ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
}

void indent_widget(const std::string& name, const Columns& columns) {
    if (is_tall(name, columns)) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + mark_width());
}

RowAct draw_menu(PanelState& state, const RowLine& line) {
    RowAct act = RowAct::None;
    if (!ImGui::BeginPopup("menu")) return act;
    if (ImGui::MenuItem("Reset", "double-click")) act = RowAct::Reset;
    if (line.more != nullptr && ImGui::MenuItem(line.more)) act = RowAct::More;
    if (line.more != nullptr) state.note(line.place + ".more");
    ImGui::Separator();
    if (!line.flag.empty() && ImGui::MenuItem("Copy as flag")) ImGui::SetClipboardText(line.flag.c_str());
    if (ImGui::MenuItem("Copy as TOML")) ImGui::SetClipboardText(line.toml.c_str());
    ImGui::EndPopup();
    return act;
}

bool has_double_click_of_its_own(Kind kind) { return kind == Kind::Curve || kind == Kind::Toggle; }

}  // namespace

void explain(const RowLine& line) {
    if (!is_rested_on()) return;
    const ParamInfo& row = *line.row;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(full_doc(row).c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    std::string allowed = interval(row);
    if (row.kind != Kind::Resource && row.kind != Kind::Curve)
        allowed += fmt::format(", default {}", flag_text(row, line.defaults));
    ImGui::TextUnformatted(allowed.c_str());
    ImGui::TextUnformatted(line.toml.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

Columns Columns::of(std::span<const std::string> names) {
    float widest = 0;
    for (const std::string& name : names) widest = std::max(widest, ImGui::CalcTextSize(name.c_str()).x);
    return {std::min(widest, ImGui::GetContentRegionAvail().x * 0.48f)};
}

void draw_line(const std::string& name, const char* sentence, const Columns& columns,
               const std::function<void()>& body) {
    ImGui::PushID(name.c_str());
    draw_name(name, columns, false);
    tooltip(sentence);
    indent_widget(name, columns);
    ImGui::SetNextItemWidth(-FLT_MIN);
    body();
    ImGui::PopID();
}

void draw_file_choice(PanelState& state, const std::string& what, const std::string& file, FileKind kind,
                      const std::function<void(const std::string&)>& put) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - (file.empty() ? 0 : ImGui::GetFrameHeight() + gap);
    const std::string shown = file.empty() ? "Choose..."
                                           : fitting(printable(std::filesystem::path(file).filename().string()),
                                                     width - 2 * ImGui::GetStyle().FramePadding.x, KeptPart::End);
    ImGui::BeginGroup();
    ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
    const bool is_chosen = ImGui::Button((shown + "##file").c_str(), {width, 0});
    ImGui::PopStyleVar();
    if (is_chosen) state.browse(fmt::format("A file for {}", what), kind, file, put);
    if (!file.empty()) {
        ImGui::SameLine(0, gap);
        if (icon_button("##clear", Icon::Remove, "Takes the file away.")) put({});
    }
    ImGui::EndGroup();
}

RowOutcome draw_row(PanelState& state, const RowLine& line, const Columns& columns,
                    const std::function<ValueEdit(std::span<std::uint32_t>)>& body) {
    const ParamInfo& row = *line.row;
    const std::string name = shown_name(row.name);
    ImGui::PushID(line.place.c_str());
    draw_name(name, columns, !std::ranges::equal(line.words, line.defaults));
    state.note(line.place + ".name");
    const auto is_asked = [](int button) { return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(button); };
    bool resets = is_asked(ImGuiMouseButton_Left);
    bool opens_menu = ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right);
    explain(line);
    indent_widget(name, columns);

    RowOutcome out{.words = {line.words.begin(), line.words.end()}};
    const ValueEdit edit = body ? body(out.words) : draw_value(row, out.words, line.defaults);
    state.note(line.place);
    explain(line);
    opens_menu |= ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right);
    // The second press of a double click would hold the slider where the mouse is.
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID still_id = ImGui::GetID("still");
    bool holds_still = storage.GetBool(still_id);
    const bool is_double = !has_double_click_of_its_own(row.kind) && is_asked(ImGuiMouseButton_Left);
    if (is_double) holds_still = true;
    if (holds_still && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) holds_still = false;
    storage.SetBool(still_id, holds_still);
    resets |= is_double;
    if (edit.is_begun && !is_double) state.document->end_merge();
    if (opens_menu) ImGui::OpenPopup("menu");
    const RowAct chosen = draw_menu(state, line);
    ImGui::PopID();
    if (resets || chosen != RowAct::None)
        out.act = resets ? RowAct::Reset : chosen;
    else if (edit.is_changed && !holds_still)
        out.act = RowAct::Change;
    return out;
}

}  // namespace darkroom::panels
