// SPDX-License-Identifier: MIT
// What is shown in place of an entry's parameters: a pulse, a layer, or what the interface is.
#include <fmt/format.h>
#include <imgui.h>

#include <cfloat>

#include "core/text/param_text.hpp"
#include "panels/look/parameter_row.hpp"
#include "panels/panel_state.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/text_field.hpp"

namespace darkroom::panels {

namespace {

void draw_head(const std::string& name, const char* sentence) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(shown_name(name).c_str());
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", sentence);
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
}

void draw_heading(const std::string& text) {
    ImGui::Spacing();
    ImGui::Separator();
    ImGui::TextDisabled("%s", text.c_str());
}

void draw_value_row(PanelState& state, edit::Mover mover, std::size_t number, const edit::MovedValue& value,
                    const std::string& prefix, const Columns& columns) {
    const std::string own =
        value.entry.empty() ? std::string(value.row.name) : fmt::format("{}.{}", value.entry, value.row.name);
    const RowLine line{
        .row = &value.row,
        .words = value.words,
        .defaults = value.defaults,
        .place = prefix + "." + own,
        .flag = {},
        .toml = fmt::format("{} = {}", value.entry.empty() ? own : '"' + own + '"', format(value.row, value.words)),
        .more = value.table == "values" ? "Take out of the layer" : nullptr};
    const RowOutcome outcome = draw_row(state, line, columns);
    if (outcome.act == RowAct::None) return;
    if (outcome.act == RowAct::More)
        return state.edit(fmt::format("{} without {}", edit::name_of(state.look(), mover), shown_name(own)),
                          [=](Look& look) { return edit::remove_layer_value(look, mover.number, number); });
    state.edit(
        fmt::format("{} {}", edit::name_of(state.look(), mover), shown_name(own)),
        [=, words = outcome.act == RowAct::Reset ? value.defaults : outcome.words](Look& look) {
            return edit::set_moved(look, mover, number, words);
        },
        line.place);
}

void draw_distance_button(PanelState& state, std::size_t layer, const std::string& name) {
    const bool has_distance = state.look().layers[layer].distance.has_value();
    if (ImGui::Button(has_distance ? "Everywhere" : "By distance"))
        state.edit(fmt::format("{} {}", name, has_distance ? "everywhere" : "by distance"),
                   [=](Look& look) { return edit::set_layer_distance(look, layer, !has_distance); });
    state.note("layer/distance");
    tooltip(has_distance ? "Gives the layer the same weight wherever the camera is."
                         : "Multiplies the weight by how near the camera is to a point of the world.");
    ImGui::SameLine();
}

void draw_mover(PanelState& state, edit::Mover mover) {
    const std::vector<edit::MovedValue> values = edit::values_of(state.look(), mover);
    if (values.empty()) return state.part.reset();
    const std::string name = edit::name_of(state.look(), mover);
    const bool has_own_values = mover.is_layer && state.look().layers[mover.number].file.empty();
    const char* sentence = "Adds to a value when its event fires, and dies down.";
    if (mover.is_layer) sentence = "Replaces values of the stack, by its weight.";
    if (has_own_values)
        sentence =
            "Replaces values of the stack, by its weight. The menu of a value, on the right button, takes it "
            "out.";
    draw_head(name, sentence);
    if (!mover.is_layer) {
        const std::string& event = state.look().pulses[mover.number].event;
        if (ImGui::Button("Fire")) state.fired = event;
        state.note(fmt::format("fire/{}", event));
        tooltip("Starts all pulses of this event now.");
        ImGui::SameLine();
    }
    if (has_own_values) {
        draw_add_mover(state, {.is_layer = true, .layer = mover.number}, "Add a value", "Adds a value to the layer.",
                       "layer/add_value");
        ImGui::SameLine();
    }
    if (mover.is_layer) draw_distance_button(state, mover.number, name);
    if (ImGui::Button("Remove")) {
        state.part.reset();
        state.edit(fmt::format("remove {}", name), [mover](Look& look) { return edit::remove_mover(look, mover); });
    }
    state.note("mover/remove");
    tooltip(mover.is_layer ? "Takes the layer out of the look." : "Takes the pulse out of the look.");
    if (!state.part) return;
    std::vector<std::string> names;
    for (const edit::MovedValue& value : values) names.push_back(shown_name(value.row.name));
    const Columns columns = Columns::of(names);
    const std::string prefix = mover.is_layer ? fmt::format("layer/{}", name) : fmt::format("pulse/{}", mover.number);
    std::string group;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const edit::MovedValue& value = values[i];
        const std::string own_group = value.table == "values" ? shown_name(value.entry) : shown_name(value.table);
        if (own_group != group) draw_heading(own_group);
        group = own_group;
        draw_value_row(state, mover, i, value, prefix, columns);
    }
    if (!mover.is_layer) return;
    const std::string& file = state.look().layers[mover.number].file;
    if (!file.empty()) draw_heading(fmt::format("Its values come from {}.", printable(file)));
}

void edit_interface(PanelState& state, const std::string& what, const std::function<void(LookUi&)>& change,
                    const std::string& merge = {}) {
    state.edit(
        what,
        [change](Look& look) {
            if (!look.ui) add_ui(look);
            change(*look.ui);
            return Result<>();
        },
        merge);
}

/// True: it has changed.
bool draw_game_value(GameValue& value) {
    if (bool* const is_on = std::get_if<bool>(&value)) return ImGui::Checkbox("##value", is_on);
    if (double* const number = std::get_if<double>(&value))
        return ImGui::DragScalar("##value", ImGuiDataType_Double, number, 0.5F, nullptr, nullptr, "%.6g");
    return text_field("##value", "", std::get<std::string>(value));
}

void draw_interface(PanelState& state) {
    const LookUi ui = state.look().ui.value_or(LookUi{});
    draw_head("interface", "The interface over the finished picture, and the values of a game that it shows.");
    std::vector<std::string> names{"document", "controller 1"};
    for (const auto& [name, value] : ui.game) names.push_back(name);
    const Columns columns = Columns::of(names);
    draw_line("document", "A picture or an SVG document over the picture.", columns, [&] {
        draw_file_choice(state, "document", ui.document, FileKind::Document, [&state](const std::string& file) {
            edit_interface(state, "document", [file](LookUi& own) { own.document = file; });
        });
    });
    state.note("interface.document");
    // The last is the one to come.
    for (std::size_t i = 0; i <= ui.controllers.size(); ++i) {
        const std::string name = fmt::format("controller {}", i + 1);
        draw_line(name, "A Lua script that is called with every frame.", columns, [&] {
            const std::string file = i < ui.controllers.size() ? ui.controllers[i] : std::string();
            draw_file_choice(state, name, file, FileKind::Script, [&state, i, name](const std::string& chosen) {
                edit_interface(state, name, [i, chosen](LookUi& own) {
                    const auto at =
                        own.controllers.begin() + static_cast<std::ptrdiff_t>(std::min(i, own.controllers.size()));
                    if (at == own.controllers.end())
                        own.controllers.push_back(chosen);
                    else if (chosen.empty())
                        own.controllers.erase(at);
                    else
                        *at = chosen;
                });
            });
        });
        state.note(fmt::format("interface.{}", name));
    }
    if (!ui.game.empty()) draw_heading("Game");
    for (const auto& [name, present] : ui.game) {
        GameValue value = present;
        bool is_changed = false;
        draw_line(name, "Values of the game at the start.", columns, [&] { is_changed = draw_game_value(value); });
        state.note(fmt::format("game/{}", name));
        if (ImGui::IsItemActivated()) state.document->end_merge();
        if (is_changed)
            edit_interface(
                state, fmt::format("game {}", name), [name = name, value](LookUi& own) { own.game[name] = value; },
                fmt::format("game/{}", name));
    }
}

}  // namespace

void draw_part_panel(PanelState& state) {
    const LookPart part = *state.part;
    ImGui::PushID(part.is_interface ? "interface" : part.mover.is_layer ? "layer" : "pulse");
    ImGui::PushID(static_cast<int>(part.mover.number));
    part.is_interface ? draw_interface(state) : draw_mover(state, part.mover);
    ImGui::PopID();
    ImGui::PopID();
    state.settle();
}

}  // namespace darkroom::panels
