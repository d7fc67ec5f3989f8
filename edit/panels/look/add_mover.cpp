// SPDX-License-Identifier: MIT
// The popup that makes a pulse, a layer, or another value of a layer.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "panels/panel_state.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/text_field.hpp"

namespace darkroom::panels {

namespace {

constexpr const char* popup = "add_mover";

const ParamInfo* row_of(const std::vector<edit::Movable>& all, const NewMover& wanted) {
    const auto found = std::ranges::find_if(
        all, [&](const edit::Movable& one) { return one.entry == wanted.entry && one.row->name == wanted.parameter; });
    return found == all.end() ? nullptr : found->row;
}

/// The amount of the entry, or its first value.
void choose_value(const std::vector<edit::Movable>& all, NewMover& wanted) {
    const auto is_own = [&](const edit::Movable& one) { return one.entry == wanted.entry; };
    auto found = std::ranges::find_if(all, [&](const edit::Movable& one) { return is_own(one) && one.row->is_amount; });
    if (found == all.end()) found = std::ranges::find_if(all, is_own);
    if (found != all.end()) wanted.parameter = found->row->name;
}

/// What is selected, or is on, is what somebody wants to move.
void choose_entry(const PanelState& state, const std::vector<edit::Movable>& all, NewMover& wanted) {
    const std::vector<std::string> names = entry_names(state.look());
    const auto is_there = [&](const std::string& name) { return std::ranges::count(all, name, &edit::Movable::entry); };
    wanted.entry = all.empty() ? std::string() : all.front().entry;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const LookEntry& entry = state.look().entries[i];
        if (is_there(names[i]) == 0 || (state.last_selected != entry.id && entry.state.enabled.on == 0)) continue;
        wanted.entry = names[i];
        if (state.last_selected == entry.id) break;
    }
    choose_value(all, wanted);
}

void draw_choices(PanelState& state, const std::vector<edit::Movable>& all, NewMover& wanted) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::BeginCombo("##entry", shown_name(wanted.entry).c_str())) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i > 0 && all[i].entry == all[i - 1].entry) continue;
            const bool is_chosen = all[i].entry == wanted.entry;
            if (ImGui::Selectable(shown_name(all[i].entry).c_str(), is_chosen) && !is_chosen) {
                wanted.entry = all[i].entry;
                choose_value(all, wanted);
            }
        }
        ImGui::EndCombo();
    }
    state.note("mover/entry");
    tooltip("The effect whose value moves.");
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::BeginCombo("##value", shown_name(wanted.parameter).c_str())) {
        for (const edit::Movable& one : all)
            if (one.entry == wanted.entry &&
                ImGui::Selectable(shown_name(one.row->name).c_str(), one.row->name == wanted.parameter))
                wanted.parameter = one.row->name;
        ImGui::EndCombo();
    }
    state.note("mover/value");
    if (const ParamInfo* const row = row_of(all, wanted)) tooltip(full_doc(*row).c_str());
}

void add(PanelState& state, const NewMover& wanted) {
    const std::string value = fmt::format("{}.{}", wanted.entry, wanted.parameter);
    if (wanted.layer)
        return state.edit(fmt::format("add {}", value), [wanted](Look& look) {
            return edit::add_layer_value(look, *wanted.layer, wanted.entry, wanted.parameter);
        });
    state.edit(fmt::format("add {} {}", wanted.is_layer ? "layer" : "pulse", wanted.name),
               [&state, wanted](Look& look) -> Result<> {
                   DARKROOM_TRY_VALUE(const std::size_t made,
                                      wanted.is_layer
                                          ? edit::add_layer(look, wanted.name, wanted.entry, wanted.parameter)
                                          : edit::add_pulse(look, wanted.name, wanted.entry, wanted.parameter));
                   state.wanted_part = LookPart{.mover = {wanted.is_layer, made}};
                   return {};
               });
}

void add_of_file(PanelState& state, const std::string& name) {
    ImGui::CloseCurrentPopup();
    state.files.open({.title = "A look as a layer",
                      .start = state.document->options().folder,
                      .extensions = {".toml"},
                      .then = [&state, name](const std::filesystem::path& file) {
                          // Made when the panel has been drawn.
                          state.edit(fmt::format("add layer {}", name), [&state, name, file](Look& look) -> Result<> {
                              const LookOptions& options = state.document->options();
                              const std::string relative = file.lexically_proximate(options.folder).string();
                              DARKROOM_TRY_VALUE(const std::size_t made,
                                                 edit::add_layer_of(look, name, relative, options));
                              state.wanted_part = LookPart{.mover = {true, made}};
                              return {};
                          });
                      }});
}

void draw_popup(PanelState& state) {
    ImGui::SetNextWindowSize({18 * ImGui::GetFontSize(), 0});
    if (!ImGui::BeginPopup(popup)) return;
    NewMover& wanted = state.new_mover;
    const std::vector<edit::Movable> all = edit::movable_values(state.look(), wanted.is_layer);
    if (ImGui::IsWindowAppearing()) choose_entry(state, all, wanted);
    bool is_taken = false;
    if (!wanted.layer) {
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-FLT_MIN);
        is_taken = text_field("##name", wanted.is_layer ? "Name, such as night" : "Event, such as hit", wanted.name,
                              ImGuiInputTextFlags_EnterReturnsTrue);
        state.note("mover/name");
        tooltip(wanted.is_layer ? "Name by which a game calls the layer: letters, digits, '_' and '-'."
                                : "Event by which a game fires the pulse: letters, digits, '_' and '-'.");
    }
    draw_choices(state, all, wanted);
    const bool can_add = !wanted.entry.empty() && (wanted.layer || is_look_name(wanted.name));
    ImGui::BeginDisabled(!can_add);
    is_taken |= ImGui::Button("Add", {-FLT_MIN, 0});
    ImGui::EndDisabled();
    state.note("mover/add");
    if (wanted.is_layer && !wanted.layer) {
        ImGui::BeginDisabled(!is_look_name(wanted.name));
        if (ImGui::Button("Add the look of a file...", {-FLT_MIN, 0})) add_of_file(state, wanted.name);
        ImGui::EndDisabled();
        state.note("mover/file");
        tooltip("At a weight of 1 the entries that both looks have take the values of that look.");
    }
    if (is_pressed(ImGuiKey_Escape, false)) ImGui::CloseCurrentPopup();
    if (is_taken && can_add) {
        add(state, wanted);
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace

void draw_add_mover(PanelState& state, const NewMover& what, const char* label, const char* help,
                    const std::string& place) {
    ImGui::PushID(place.c_str());
    if (ImGui::Button(label)) {
        state.new_mover = what;
        ImGui::OpenPopup(popup);
    }
    state.note(place);
    tooltip(help);
    draw_popup(state);
    ImGui::PopID();
}

}  // namespace darkroom::panels
