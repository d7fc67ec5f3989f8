// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <darkroom/effect.hpp>
#include <iterator>
#include <map>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "edit/effect_uses.hpp"
#include "panels/panel_state.hpp"
#include "panels/panels.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/text_field.hpp"
#include "panels/widgets/theme.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

namespace {

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

/// In whatever case.
bool has(std::string_view text, std::string_view filter) {
    const auto is_alike = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), filter.begin(), filter.end(), is_alike) != text.end();
}

bool is_wanted(const EffectInfo& effect, std::string_view purpose, std::string_view filter) {
    return has(shown_name(effect.name), filter) || has(effect.doc, filter) || has(purpose, filter);
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
    "The table becomes a list of entries, [[stack]], in the same order. Effects that are off and were never set leave "
    "the list.";

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
    if (!effect.flat.is_of_ui()) {
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

struct Offered {
    std::string_view purpose;
    const EffectInfo* effect = nullptr;
};
/// By what they are for; those that do not say it come last.
std::vector<Offered> wanted_effects(const PanelState& state) {
    std::vector<Offered> out;
    const auto add_those_for = [&](std::string_view purpose) {
        for (const EffectInfo* const effect : all_effects())
            if (edit::purpose_of(*effect) == purpose && is_wanted(*effect, purpose, state.filter))
                out.push_back({purpose, effect});
    };
    for (const std::string_view purpose : edit::purposes) add_those_for(purpose);
    add_those_for({});
    return out;
}

std::string heading_of(std::string_view purpose) {
    if (purpose.empty()) return "Other";
    std::string out(purpose);
    out.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(out.front())));
    return out;
}

/// The room of a picture, in heights of the font.
constexpr float picture_width = 6, picture_height = 3.4F;

/// As large as it fits into its room, in the middle.
template <class Picture>
void draw_thumbnail(PanelState& state, const Picture& picture, ImVec2 corner, const std::string& place) {
    const float em = ImGui::GetFontSize();
    const ImVec2 room{picture_width * em, picture_height * em};
    if (!ImGui::IsRectVisible(corner, {corner.x + room.x, corner.y + room.y})) return;
    const Thumbnail found = picture();
    if (!found.error.empty()) {
        const float wrap = ImGui::GetContentRegionAvail().x - (picture_width + 0.5F) * em;
        ImGui::GetWindowDrawList()->AddText(
            ImGui::GetFont(), em, {corner.x + (picture_width + 0.5F) * em, corner.y + ImGui::GetTextLineHeight()},
            ImGui::GetColorU32(error_color), found.error.c_str(), nullptr, wrap);
        return;
    }
    const ImVec2 size{std::min(room.x, room.y * found.aspect), std::min(room.y, room.x / found.aspect)};
    const ImVec2 from{std::round(corner.x + (room.x - size.x) / 2), std::round(corner.y + (room.y - size.y) / 2)};
    const ImVec2 to{from.x + size.x, from.y + size.y};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (found.texture != nullptr)
        list.AddImage(found.texture, from, to);
    else
        list.AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_FrameBg));
    if (state.places) (*state.places)[place] = {from, to};
}

/// A name and what it costs, and below them the effect's sentence, as one thing to be clicked; beside them what it
/// makes of the picture.
bool draw_effect(PanelState& state, const EffectInfo& effect, bool is_chosen) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float em = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
    const bool has_picture = state.thumbnails != nullptr;
    const float indent = has_picture ? (picture_width + 0.5F) * em : em;
    const std::string doc(effect.doc);
    const float wrap = width - indent;
    const float text =
        ImGui::GetTextLineHeight() + ImGui::CalcTextSize(doc.c_str(), nullptr, false, wrap).y + style.ItemSpacing.y;
    const float height = has_picture ? std::max(text, picture_height * em) : text;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool is_pressed = ImGui::Selectable("##effect", is_chosen, 0, {0, height});
    if (has_picture)
        draw_thumbnail(
            state, [&] { return state.thumbnails(effect); }, corner, fmt::format("add/{}.picture", effect.name));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const char* const cost = costs().at(&effect);
    list.AddText({corner.x + indent, corner.y}, ImGui::GetColorU32(ImGuiCol_Text), shown_name(effect.name).c_str());
    list.AddText({corner.x + width - ImGui::CalcTextSize(cost).x, corner.y}, dim, cost);
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {corner.x + indent, corner.y + ImGui::GetTextLineHeight()},
                 dim, doc.c_str(), nullptr, wrap);
    return is_pressed;
}

/// The row of the keyboard stands out, and is scrolled to where it moved.
void draw_effects(PanelState& state, std::span<const Offered> wanted, bool moved) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [purpose, effect] = wanted[i];
        if (i == 0 || purpose != wanted[i - 1].purpose) ImGui::TextDisabled("%s", heading_of(purpose).c_str());
        ImGui::PushID(effect);
        if (draw_effect(state, *effect, i == state.add_row)) add(state, *effect);
        if (moved && i == state.add_row) ImGui::SetScrollHereY();
        state.note(fmt::format("add/{}", effect->name));
        ImGui::PopID();
    }
    if (wanted.empty()) ImGui::TextDisabled("No effect has this in its name, sentence or purpose.");
}

/// Where it is open, the field that its letters go to has been drawn.
bool begin_menu(PanelState& state, const char* name, const char* hint, bool has_pictures) {
    const float em = ImGui::GetFontSize(), width = has_pictures ? 30 : 24;
    ImGui::SetNextWindowSize({width * em, std::min(36 * em, ImGui::GetIO().DisplaySize.y * 0.7f)});
    if (!ImGui::BeginPopup(name)) return false;
    state.adding_frame = ImGui::GetFrameCount();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, std::round(em / 3)});
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const std::string before = state.filter;
    // With this flag arrows are the field's, and not ImGui's, which would take the keyboard elsewhere.
    text_field("##filter", hint, state.filter, ImGuiInputTextFlags_CallbackHistory);
    if (state.filter != before) state.add_row = 0;
    return true;
}

void end_menu() {
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

/// What the keyboard does with the rows of a menu.
struct MenuKeys {
    bool has_moved = false, is_taken = false;
};
MenuKeys take_keys(PanelState& state, std::size_t rows) {
    const std::size_t row = state.add_row;
    if (is_pressed(ImGuiKey_DownArrow)) ++state.add_row;
    if (is_pressed(ImGuiKey_UpArrow) && state.add_row > 0) --state.add_row;
    state.add_row = std::min(state.add_row, rows == 0 ? 0 : rows - 1);
    if (is_pressed(ImGuiKey_Escape, false)) ImGui::CloseCurrentPopup();
    return {.has_moved = row != state.add_row,
            .is_taken = rows > 0 && (is_pressed(ImGuiKey_Enter) || is_pressed(keypad_enter))};
}

void take_look(PanelState& state, const std::filesystem::path& file) {
    ImGui::CloseCurrentPopup();
    state.edit(fmt::format("look {}", file.stem().string()), [&state, file](Look& look) -> Result<> {
        DARKROOM_TRY_VALUE(Look read, state.looks->read(file));
        edit::take_look(look, std::move(read), file.parent_path(), state.document->options().folder);
        return {};
    });
}

/// A name beside what the look makes of the picture.
bool draw_look(PanelState& state, const std::filesystem::path& file, bool is_chosen) {
    const float em = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const std::string name = file.stem().string();
    const bool is_pressed = ImGui::Selectable("##look", is_chosen, 0, {0, picture_height * em});
    state.note(fmt::format("looks/{}", name));
    draw_thumbnail(
        state, [&] { return state.looks->picture(file); }, corner, fmt::format("looks/{}.picture", name));
    ImGui::GetWindowDrawList()->AddText({corner.x + (picture_width + 0.5F) * em, corner.y},
                                        ImGui::GetColorU32(ImGuiCol_Text), printable(name).c_str());
    return is_pressed;
}

}  // namespace

void draw_looks_menu(PanelState& state) {
    if (state.looks == nullptr || !begin_menu(state, "looks", "Search; arrows choose, Enter takes", true)) return;
    std::vector<std::filesystem::path> wanted;
    std::ranges::copy_if(state.looks->files, std::back_inserter(wanted),
                         [&](const std::filesystem::path& file) { return has(file.stem().string(), state.filter); });
    const MenuKeys keys = take_keys(state, wanted.size());
    ImGui::BeginChild("list");
    const std::filesystem::path* taken = keys.is_taken ? &wanted[state.add_row] : nullptr;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (draw_look(state, wanted[i], i == state.add_row)) taken = &wanted[i];
        if (keys.has_moved && i == state.add_row) ImGui::SetScrollHereY();
        ImGui::PopID();
    }
    if (wanted.empty()) ImGui::TextDisabled("No look has this in its name.");
    ImGui::EndChild();
    if (taken != nullptr) take_look(state, *taken);
    end_menu();
}

void draw_add_menu(PanelState& state) {
    if (!begin_menu(state, "add", "Search; arrows choose, Enter adds", state.thumbnails != nullptr)) return;
    const auto wanted = wanted_effects(state);
    const MenuKeys keys = take_keys(state, wanted.size());
    const bool takes_files = state.document->options().allows_custom_effects;
    ImGui::BeginChild("effects", {0, takes_files ? -ImGui::GetFrameHeightWithSpacing() : 0});
    draw_effects(state, wanted, keys.has_moved);
    ImGui::EndChild();
    if (keys.is_taken) add(state, *wanted[state.add_row].effect);
    if (takes_files && ImGui::Button("From a GLSL file...", {-FLT_MIN, 0})) add_from_file(state);
    end_menu();
}

}  // namespace darkroom::panels
