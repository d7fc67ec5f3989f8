// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "looks/look_parts.hpp"
#include "panels/look/parameter_row.hpp"
#include "panels/panel_state.hpp"

namespace darkroom::panels {

namespace {

struct WireText {
    const char* sentence;
    const char* unwired;
};

WireText text_of(std::string_view wire) {
    if (wire == "input") return {"The picture that it changes.", "what comes before it"};
    if (wire == "source") return {"The picture that its passes read instead.", "the picture"};
    if (wire == "second") return {"The second picture that it reads.", "none"};
    return {"Luminance of this picture scales its opacity, pixel by pixel.", "none"};
}

/// Is it of use to the effect?
bool takes(const EffectInfo& effect, std::string_view wire) {
    if (wire == "source") return effect.build != nullptr;
    if (wire == "second") return effect.has_second();
    return true;
}

/// A name for an output, made of an entry's: wires take letters, digits, '_' and '-'.
std::string output_name(const Look& look, std::string_view entry) {
    std::string base(entry);
    std::ranges::replace(base, '#', '_');
    std::string name = base;
    const auto is_taken = [&](const std::string& wanted) {
        return std::ranges::any_of(given_wires, [&](const GivenWire& wire) { return wire.first == wanted; }) ||
               std::ranges::count(look.entries, wanted, &LookEntry::output) > 0;
    };
    for (int i = 2; is_taken(name); ++i) name = fmt::format("{}_{}", base, i);
    return name;
}

/// Wires `entry` to another's output, which gets a name where it has none.
Result<> wire_to(Look& look, const std::string& entry, const std::string& wire, const std::string& other,
                 bool is_previous, const LookOptions& options) {
    const LookEntry* const found = find_entry(look, other);
    if (found == nullptr) return user_error(fmt::format("{}: no entry of the look has this name", other));
    std::string output = found->output;
    if (output.empty()) {
        output = output_name(look, other);
        DARKROOM_TRY(edit::set_wire(look, other, "output", output, options));
    }
    if (is_previous) output += previous_suffix;
    return edit::set_wire(look, entry, wire, output, options);
}

class WireChoices {
  public:
    WireChoices(PanelState& state, const LookEntry& entry, const std::string& name, const WireInfo& wire)
        : state_(state), entry_(entry), name_(name), wire_(wire), present_(entry.*wire.member) {}

    void draw() {
        const char* const unwired = text_of(wire_.key).unwired;
        if (!ImGui::BeginCombo("##wire", present_.empty() ? unwired : printable(present_).c_str(),
                               ImGuiComboFlags_HeightLarge))
            return;
        if (ImGui::Selectable(unwired, present_.empty())) set({});
        ImGui::Separator();
        for (const auto& [given, handle] : given_wires)
            if (ImGui::Selectable(std::string(given).c_str(), present_ == given)) set(std::string(given));
        const std::vector<std::string> names = entry_names(state_.look());
        bool is_before = true;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const LookEntry& other = state_.look().entries[i];
            if (other.is_of_ui) continue;
            is_before &= &other != &entry_;
            if (is_before) offer(other, names[i], false);
        }
        ImGui::Separator();
        const std::string previous_scene = fmt::format("{}{}", scene_name, previous_suffix);
        if (ImGui::Selectable(previous_scene.c_str(), present_ == previous_scene)) set(previous_scene);
        for (std::size_t i = 0; i < names.size(); ++i)
            if (!state_.look().entries[i].is_of_ui) offer(state_.look().entries[i], names[i], true);
        ImGui::Separator();
        if (ImGui::Selectable("A picture's file...", is_file_name(present_))) browse();
        ImGui::EndCombo();
    }

  private:
    [[nodiscard]] std::string what() const { return fmt::format("{} {}", name_, wire_.key); }

    void set(const std::string& value) {
        state_.edit(what(), [name = name_, wire = wire_.key, value, document = state_.document](Look& look) {
            return edit::set_wire(look, name, wire, value, document->options());
        });
    }
    void offer(const LookEntry& other, const std::string& other_name, bool is_previous) {
        const std::string_view suffix = is_previous ? previous_suffix : std::string_view();
        const std::string label = fmt::format("{}{}", other_name, suffix);
        const bool is_present = !other.output.empty() && present_ == fmt::format("{}{}", other.output, suffix);
        const bool is_chosen = ImGui::Selectable(label.c_str(), is_present);
        state_.note(fmt::format("wire/{}", label));
        if (!is_chosen) return;
        state_.edit(what(), [=, name = name_, wire = std::string(wire_.key), document = state_.document](Look& look) {
            return wire_to(look, name, wire, other_name, is_previous, document->options());
        });
    }
    void browse() {
        state_.browse(fmt::format("A picture for {}", what()), FileKind::Picture,
                      is_file_name(present_) ? present_ : std::string(),
                      [this_state = &state_, what = what(), name = name_, wire = wire_.key](const std::string& file) {
                          this_state->edit(what, [=, document = this_state->document](Look& look) {
                              return edit::set_wire(look, name, wire, file, document->options());
                          });
                      });
    }

    PanelState& state_;
    const LookEntry& entry_;
    const std::string& name_;
    const WireInfo& wire_;
    const std::string& present_;
};

void draw_state_row(PanelState& state, const LookEntry& entry, const std::string& name, const ParamInfo& row,
                    const Columns& columns) {
    const StateWords words = state_words(entry.state);
    const std::string place = fmt::format("{}.{}", name, row.name);
    const RowLine line{.row = &row,
                       .words = std::span(words).subspan(row.word, row.words),
                       .defaults = entry_rows.defaults.subspan(row.word, row.words),
                       .place = place,
                       .flag = fmt::format("--set {}={}", place, flag_text(row, std::span(words).subspan(row.word, 1))),
                       .toml = fmt::format("{} = {}", row.name, format(row, words))};
    const RowOutcome outcome = draw_row(state, line, columns);
    if (outcome.act == RowAct::None) return;
    std::vector<std::uint32_t> wanted = outcome.words;
    if (outcome.act == RowAct::Reset) wanted.assign(line.defaults.begin(), line.defaults.end());
    state.edit(
        fmt::format("{} {}", name, row.name),
        [=, key = row.name](Look& look) { return edit::set_state(look, name, key, wanted); }, place);
}

}  // namespace

void add_state_names(std::vector<std::string>& names) {
    for (const ParamInfo& row : entry_rows.rows) names.push_back(shown_name(row.name));
    for (const WireInfo& wire : wires) names.emplace_back(wire.key);
}

void draw_entry_state(PanelState& state, const LookEntry& entry, const std::string& name, const Columns& columns) {
    const auto heading = [](const char* text) {
        ImGui::Spacing();
        ImGui::Separator();
        ImGui::TextDisabled("%s", text);
    };
    heading("Over the picture");
    for (const ParamInfo& row : entry_rows.rows)
        if (row.kind != Kind::Toggle) draw_state_row(state, entry, name, row, columns);
    heading("Wires");
    for (const WireInfo& wire : wires) {
        if (!wire.is_reference || !takes(*entry.effect, wire.key)) continue;
        draw_line(shown_name(wire.key), text_of(wire.key).sentence, columns,
                  [&] { WireChoices(state, entry, name, wire).draw(); });
        state.note(fmt::format("{}.{}", name, wire.key));
    }
}

}  // namespace darkroom::panels
