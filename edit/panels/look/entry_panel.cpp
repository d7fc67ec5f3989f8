// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "looks/apply/look_resources.hpp"
#include "panels/look/entry_rows.hpp"
#include "panels/panel_state.hpp"
#include "panels/show/light_histogram.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"

namespace darkroom::panels {

namespace {

/// "--bloom-intensity 0.08", or with an entry that has no flag of its own "--set bloom#2.intensity=0.08"; and the same
/// as a line of the file.
void name_value(RowLine& line, const Look& look, const LookEntry& entry, const std::string& name,
                const std::string& flag_value, const std::string& toml_value) {
    const ParamInfo& row = *line.row;
    const bool is_flat = look.is_flat || entry.is_of_ui;
    const std::string key = flat_key(entry.effect->name, row.name);
    line.flag = is_flat ? fmt::format("{} {}", flag_name(key), flag_value)
                        : fmt::format("--set {}.{}={}", name, row.name, flag_value);
    line.toml = fmt::format("{} = {}", is_flat ? key : std::string(row.name), toml_value);
}

/// What undo calls a change of the parameter.
std::string step_name(const std::string& name, const ParamInfo& row) {
    return name == row.name ? name : fmt::format("{} {}", name, shown_name(row.name));
}

/// The file's name, and buttons to choose another and to go without.
ValueEdit draw_file(PanelState& state, const LookEntry& entry, const std::string& name, const ParamInfo& row) {
    const LookResource* const present = resource_of(entry, row);
    const std::string file = present == nullptr ? std::string() : present->file;
    const std::string parameter(row.name), what = step_name(name, row);
    edit::LookDocument* const document = state.document;
    draw_file_choice(state, what, file, row.is_picture ? FileKind::Picture : FileKind::Table,
                     [=, &state](const std::string& chosen) {
                         state.edit(what, [=](Look& look) {
                             return edit::set_file(look, name, parameter, chosen, document->options());
                         });
                     });
    return {};
}

void draw_head(PanelState& state, const LookEntry& entry, const std::string& name) {
    const bool is_on = entry.state.enabled.on != 0;
    if (icon_button("##enabled", is_on ? Icon::Shown : Icon::Hidden, is_on ? "Switches it off." : "Switches it on.",
                    !is_on))
        state.edit(fmt::format("{} {}", name, is_on ? "off" : "on"), [=](Look& look) {
            const std::uint32_t on = is_on ? 0 : 1;
            return edit::set_state(look, name, "enabled", {&on, 1});
        });
    state.note(name + ".enabled");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x;
    ImGui::TextUnformatted(fitting(shown_name(name), room, KeptPart::Start).c_str());
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::GetFrameHeight());
    if (icon_button("##reset", Icon::Reset, "Sets all of its parameters to their defaults."))
        state.edit(fmt::format("{} reset", name), [=](Look& look) { return edit::reset_entry(look, name); });
    state.note(name + ".reset");
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(std::string(entry.effect->doc).c_str());
    if (const std::string_view why = left_out(state.plan, name); is_on && !why.empty())
        ImGui::TextUnformatted(fmt::format("Left out: {}.", why).c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::Spacing();
}

/// Of an effect that meters.
void draw_metered(PanelState& state, const LookEntry& entry, const std::string& name) {
    if (!state.numbers || entry.state.enabled.on == 0) return;
    const std::string value = fmt::format("{}.histogram", entry.effect->name);
    const std::optional<LightHistogram> histogram = light_histogram_of(state.numbers(value));
    if (!histogram) return;
    ImGui::BeginGroup();
    draw_light_histogram(*histogram);
    ImGui::EndGroup();
    state.note(name + ".histogram");
}

}  // namespace

RowLine line_of(const PanelState& state, const LookEntry& entry, const std::string& name, const ParamInfo& row) {
    RowLine line{.row = &row,
                 .words = std::span(entry.words).subspan(row.word, row.words),
                 .defaults = entry.effect->parameters.defaults.subspan(row.word, row.words),
                 .place = fmt::format("{}.{}", name, row.name)};
    const std::string toml = value_text(entry, row);
    const std::string flag = row.kind == Kind::Resource ? toml : flag_text(row, line.words);
    name_value(line, state.look(), entry, name, flag, toml);
    return line;
}

void apply(PanelState& state, const std::string& name, const RowLine& line, const RowOutcome& outcome) {
    if (outcome.act == RowAct::None) return;
    const std::string parameter(line.row->name), what = step_name(name, *line.row);
    if (outcome.act == RowAct::Reset)
        state.edit(
            what, [=](Look& look) { return edit::reset_value(look, name, parameter); }, line.place);
    else
        state.edit(
            what, [=, words = outcome.words](Look& look) { return edit::set_value(look, name, parameter, words); },
            line.place);
}

void draw_parameter(PanelState& state, const LookEntry& entry, const std::string& name, const ParamInfo& row,
                    const Columns& columns) {
    const RowLine line = line_of(state, entry, name, row);
    std::function<ValueEdit(std::span<std::uint32_t>)> body;
    if (row.kind == Kind::Resource) body = [&](std::span<std::uint32_t>) { return draw_file(state, entry, name, row); };
    apply(state, name, line, draw_row(state, line, columns, body));
}

void draw_entry_panel(PanelState& state) {
    const int index = state.selected_index();
    if (index < 0) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("Select an effect in the stack to see its parameters.");
        ImGui::PopTextWrapPos();
        return;
    }
    const LookEntry& entry = state.look().entries[static_cast<std::size_t>(index)];
    const std::string name = entry_names(state.look())[static_cast<std::size_t>(index)];
    ImGui::PushID(static_cast<int>(entry.id));
    draw_head(state, entry, name);
    draw_metered(state, entry, name);
    std::vector<std::string> names;
    for (const ParamInfo& row : entry.effect->parameters.rows) names.push_back(shown_name(row.name));
    const bool has_state = !state.look().is_flat && !entry.is_of_ui;
    if (has_state) add_state_names(names);
    const Columns columns = Columns::of(names);
    if (!draw_grouped_rows(state, entry, name))
        for (const ParamInfo& row : entry.effect->parameters.rows) draw_parameter(state, entry, name, row, columns);
    if (has_state) draw_entry_state(state, entry, name, columns);
    ImGui::PopID();
    state.settle();
}

}  // namespace darkroom::panels
