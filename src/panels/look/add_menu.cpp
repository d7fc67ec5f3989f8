// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <darkroom/effect.hpp>

#include "edit/edits.hpp"
#include "panels/panel_state.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/text_field.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

namespace {

struct Group {
    const char* heading;
    bool (*holds)(const EffectInfo& effect);
};

bool accepts_only(const EffectInfo& effect, Domain domain) {
    return !effect.is_ui && effect.accepts.bits == Domains::only(domain).bits;
}
bool accepts_several(const EffectInfo& effect) {
    return !effect.is_ui && (effect.accepts.bits & (effect.accepts.bits - 1)) != 0;
}

/// Every effect is in one of them.
constexpr std::array<Group, 5> groups{{
    {"Scene-linear light", [](const EffectInfo& effect) { return accepts_only(effect, Domain::SceneLinear); }},
    {"Display-linear light", [](const EffectInfo& effect) { return accepts_only(effect, Domain::DisplayLinear); }},
    {"Encoded picture", [](const EffectInfo& effect) { return accepts_only(effect, Domain::Encoded); }},
    {"Any picture", accepts_several},
    {"Interface", [](const EffectInfo& effect) { return effect.is_ui; }},
}};

const char* text_of(const EffectInfo& effect) {
    if (effect.touch == Touch::Warp || effect.touch == Touch::Map) return "moves pixels";
    if (effect.touch == Touch::History) return "earlier frames";
    if (effect.touch == Touch::Tap || effect.touch == Touch::Neighbourhood) return "neighbours";
    return effect.build ? "own passes" : "colour";
}

bool is_wanted(const EffectInfo& effect, std::string_view filter) {
    const auto has = [&](std::string_view text) {
        const auto is_alike = [](char a, char b) {
            return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
        };
        return std::search(text.begin(), text.end(), filter.begin(), filter.end(), is_alike) != text.end();
    };
    return filter.empty() || has(shown_name(effect.name)) || has(effect.doc);
}

/// Takes the result of an edit that adds, so that what was added is selected.
Result<> select_added(PanelState& state, const Result<std::string>& added) {
    if (!added) return failure(added.error());
    state.wanted = *added;
    return {};
}

void add(PanelState& state, const EffectInfo& effect) {
    state.edit(fmt::format("add {}", effect.name),
               [&state, &effect](Look& look) { return select_added(state, edit::add_effect(look, effect)); });
    ImGui::CloseCurrentPopup();
}

void add_from_file(PanelState& state) {
    ImGui::CloseCurrentPopup();
    state.files.open({.title = "An effect in a GLSL file",
                      .start = state.document->options().folder,
                      .extensions = {".glsl"},
                      .then = [&state](const std::filesystem::path& file) {
                          state.edit(fmt::format("add {}", file.filename().string()), [&state, file](Look& look) {
                              Result<LookEntry> entry = custom_entry(file);
                              if (!entry) return Result<>(failure(entry.error()));
                              return select_added(state, edit::add_entry(look, std::move(*entry)));
                          });
                      }});
}

/// Returns the first effect that is shown.
const EffectInfo* draw_effects(PanelState& state) {
    const EffectInfo* first = nullptr;
    for (const Group& group : groups) {
        bool has_heading = false;
        for (const EffectInfo* const effect : all_effects()) {
            if (!group.holds(*effect) || !is_wanted(*effect, state.filter)) continue;
            if (!has_heading) ImGui::TextDisabled("%s", group.heading);
            has_heading = true;
            if (first == nullptr) first = effect;
            const std::string name = shown_name(effect->name);
            if (ImGui::Selectable(fmt::format("  {}", name).c_str())) add(state, *effect);
            state.note(fmt::format("add/{}", effect->name));
            tooltip(std::string(effect->doc).c_str());
            const char* const touch = text_of(*effect);
            ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(touch).x);
            ImGui::TextDisabled("%s", touch);
        }
    }
    return first;
}

}  // namespace

void draw_add_menu(PanelState& state) {
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowSize({22 * em, std::min(30 * em, ImGui::GetIO().DisplaySize.y * 0.7f)});
    if (!ImGui::BeginPopup("add")) return;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, std::round(em / 3)});
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool takes_first = text_field("##filter", "Search", state.filter, ImGuiInputTextFlags_EnterReturnsTrue);
    const bool takes_files = state.document->options().allows_custom_effects;
    ImGui::BeginChild("effects", {0, takes_files ? -ImGui::GetFrameHeightWithSpacing() : 0});
    const EffectInfo* const first = draw_effects(state);
    if (first == nullptr) ImGui::TextDisabled("No effect has this in its name or sentence.");
    ImGui::EndChild();
    if (takes_first && first != nullptr) add(state, *first);
    if (takes_files && ImGui::Button("From a GLSL file...", {-FLT_MIN, 0})) add_from_file(state);
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

}  // namespace darkroom::panels
