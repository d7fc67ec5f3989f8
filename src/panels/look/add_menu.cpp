// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <darkroom/effect.hpp>
#include <map>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "edit/effect_uses.hpp"
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

/// What it costs, as the kind of work that it is.
const char* text_of(const EffectInfo& effect) {
    if (effect.touch == Touch::Warp || effect.touch == Touch::Map) return "moves pixels";
    if (effect.touch == Touch::History) return "earlier frames";
    if (effect.touch == Touch::Tap) return "neighbours";
    if (edit::uses_of(effect).has_passes) return "own passes";
    return effect.touch == Touch::Neighbourhood ? "neighbours" : "colour";
}
/// Listening to `build` in every frame is too much.
const std::map<const EffectInfo*, const char*>& costs() {
    static const std::map<const EffectInfo*, const char*> known = [] {
        std::map<const EffectInfo*, const char*> out;
        for (const EffectInfo* const effect : all_effects()) out.emplace(effect, text_of(*effect));
        return out;
    }();
    return known;
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

void add_now(PanelState& state, const EffectInfo& effect) {
    state.edit(fmt::format("add {}", effect.name),
               [&state, &effect](Look& look) { return select_added(state, edit::add_effect(look, effect)); });
}

constexpr const char* becomes_stack =
    "The table becomes a list of entries, [[stack]], in the same order. What is off and was never set leaves the list.";

void add(PanelState& state, const EffectInfo& effect) {
    ImGui::CloseCurrentPopup();
    using Kind = edit::Addition::Kind;
    const edit::Addition addition = edit::addition_of(state.look(), effect);
    const std::string name = shown_name(effect.name);
    const auto make_stack = [&state, &effect] { add_now(state, effect); };
    if (addition.kind == Kind::MakesStack)
        return state.ask({.text = fmt::format("The flat table has no place for {}. {}", name, becomes_stack),
                          .answers = {{"Make a stack", make_stack}}});
    if (addition.kind != Kind::IsThere) return add_now(state, effect);
    PanelState::Question question{.text = fmt::format("{} is in the table already, and on.", name),
                                  .answers = {{"Show it", [&state, entry = addition.entry] { state.select(entry); }}}};
    if (!effect.flat.is_of_ui) {
        question.text += fmt::format(" For a second one: {}", becomes_stack);
        question.answers.emplace_back("Add a second one", make_stack);
    }
    state.ask(std::move(question));
}

void add_from_file(PanelState& state) {
    ImGui::CloseCurrentPopup();
    const auto take = [&state](const std::filesystem::path& file) {
        state.edit(fmt::format("add {}", file.filename().string()), [&state, file](Look& look) {
            Result<LookEntry> entry = custom_entry(file);
            if (!entry) return Result<>(failure(entry.error()));
            return select_added(state, edit::add_entry(look, std::move(*entry)));
        });
    };
    state.files.open({.title = "An effect in a GLSL file",
                      .start = state.document->options().folder,
                      .extensions = {".glsl"},
                      .then = [&state, take](const std::filesystem::path& file) {
                          if (!state.look().is_flat) return take(file);
                          state.ask({.text = fmt::format("The flat table has no place for {}. {}",
                                                         printable(file.filename().string()), becomes_stack),
                                     .answers = {{"Make a stack", [take, file] { take(file); }}}});
                      }});
}

/// Those that are offered, group by group.
std::vector<std::pair<const Group*, const EffectInfo*>> wanted_effects(const PanelState& state) {
    std::vector<std::pair<const Group*, const EffectInfo*>> out;
    for (const Group& group : groups)
        for (const EffectInfo* const effect : all_effects())
            if (group.holds(*effect) && is_wanted(*effect, state.filter)) out.emplace_back(&group, effect);
    return out;
}

/// The row of the keyboard stands out, and is scrolled to where it moved.
void draw_effects(PanelState& state, std::span<const std::pair<const Group*, const EffectInfo*>> wanted, bool moved) {
    const Group* last = nullptr;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [group, effect] = wanted[i];
        if (group != last) ImGui::TextDisabled("%s", group->heading);
        last = group;
        const std::string name = shown_name(effect->name);
        if (ImGui::Selectable(fmt::format("  {}", name).c_str(), i == state.add_row)) add(state, *effect);
        if (moved && i == state.add_row) ImGui::SetScrollHereY();
        state.note(fmt::format("add/{}", effect->name));
        tooltip(std::string(effect->doc).c_str());
        const char* const cost = costs().at(effect);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(cost).x);
        ImGui::TextDisabled("%s", cost);
    }
    if (wanted.empty()) ImGui::TextDisabled("No effect has this in its name or sentence.");
}

}  // namespace

void draw_add_menu(PanelState& state) {
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowSize({22 * em, std::min(30 * em, ImGui::GetIO().DisplaySize.y * 0.7f)});
    if (!ImGui::BeginPopup("add")) return;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, std::round(em / 3)});
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const std::string before = state.filter;
    // With this flag arrows are the field's, and not ImGui's, which would take the keyboard elsewhere.
    text_field("##filter", "Search; arrows choose, Enter adds", state.filter, ImGuiInputTextFlags_CallbackHistory);
    if (state.filter != before) state.add_row = 0;
    const auto wanted = wanted_effects(state);
    const std::size_t row = state.add_row;
    if (is_pressed(ImGuiKey_DownArrow)) ++state.add_row;
    if (is_pressed(ImGuiKey_UpArrow) && state.add_row > 0) --state.add_row;
    state.add_row = std::min(state.add_row, wanted.empty() ? 0 : wanted.size() - 1);
    if (is_pressed(ImGuiKey_Escape, false)) ImGui::CloseCurrentPopup();
    const bool is_taken = is_pressed(ImGuiKey_Enter) || is_pressed(ImGuiKey_KeyPadEnter);
    const bool takes_files = state.document->options().allows_custom_effects;
    ImGui::BeginChild("effects", {0, takes_files ? -ImGui::GetFrameHeightWithSpacing() : 0});
    draw_effects(state, wanted, row != state.add_row);
    ImGui::EndChild();
    if (is_taken && !wanted.empty()) add(state, *wanted[state.add_row].second);
    if (takes_files && ImGui::Button("From a GLSL file...", {-FLT_MIN, 0})) add_from_file(state);
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

}  // namespace darkroom::panels
