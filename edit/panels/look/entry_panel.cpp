// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"
#include "panels/look/entry_rows.hpp"
#include "panels/look/parameter_row.hpp"
#include "panels/panel_state.hpp"
#include "panels/show/light_histogram.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"

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
