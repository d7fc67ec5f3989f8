// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "looks/look_parts.hpp"
#include "panels/panel_state.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/text_field.hpp"
#include "panels/widgets/theme.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {

namespace {

constexpr const char* dragged_entry = "darkroom entry";

class StackList {
  public:
    explicit StackList(PanelState& state) : state_(state), look_(state.look()), names_(entry_names(look_)) {}

    void draw() {
        draw_head();
        ImGui::BeginChild("entries");
        draw_entries();
        ImGui::EndChild();
    }

  private:
    void draw_entries() {
        std::vector<std::size_t> picture, ui;
        for (const LookEntry* const entry : ordered(look_)) {
            const auto index = static_cast<std::size_t>(entry - look_.entries.data());
            (entry->is_of_ui ? ui : picture).push_back(index);
        }
        for (std::size_t i = 0; i < picture.size(); ++i)
            draw_entry(picture[i], i + 1 < picture.size() ? names_[picture[i + 1]] : std::string());
        if (picture.empty()) ImGui::TextDisabled("No effect: the picture stays as it is.");
        draw_heading("Interface");
        draw_part({.is_interface = true}, "document, scripts, game", "stack/interface");
        // Without a document there is nothing for them to work on.
        const bool has_document = look_.ui && !look_.ui->document.empty();
        for (const std::size_t index : ui)
            if (has_document || look_.entries[index].id == state_.selected) draw_entry(index, {});
        draw_mover_heading(false);
        for (std::size_t i = 0; i < look_.pulses.size(); ++i) draw_mover({false, i}, fmt::format("stack/pulse/{}", i));
        draw_mover_heading(true);
        for (std::size_t i = 0; i < look_.layers.size(); ++i)
            draw_mover({true, i}, fmt::format("stack/layer/{}", look_.layers[i].name));
    }

    static void draw_heading(const char* text) {
        ImGui::Spacing();
        ImGui::Separator();
        ImGui::TextDisabled("%s", text);
    }

    void draw_mover_heading(bool is_layer) {
        ImGui::Spacing();
        ImGui::Separator();
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", is_layer ? "Layers" : "Pulses");
        const float width = ImGui::CalcTextSize("+").x + 2 * ImGui::GetStyle().FramePadding.x;
        ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
        draw_add_mover(state_, {.is_layer = is_layer}, "+",
                       is_layer ? "Adds a layer: values that replace those of the stack, by its weight."
                                : "Adds a pulse, which adds to a value when its event fires.",
                       is_layer ? "stack/add_layer" : "stack/add_pulse");
    }

    void draw_mover(edit::Mover mover, const std::string& place) {
        draw_part({.mover = mover}, edit::name_of(look_, mover), place);
    }

    void draw_part(const LookPart& part, const std::string& name, const std::string& place) {
        const float indent = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
        ImGui::PushID(place.c_str());
        ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, {0, 0.5F});
        ImGui::Indent(indent);
        const std::string shown = fitting(shown_name(name), ImGui::GetContentRegionAvail().x, KeptPart::Start);
        if (ImGui::Selectable(shown.c_str(), state_.part == part, 0, {0, ImGui::GetFrameHeight()})) {
            state_.selected = 0;
            state_.part = part;
        }
        state_.note(place);
        ImGui::Unindent(indent);
        ImGui::PopStyleVar();
        ImGui::PopID();
    }

    void draw_head() {
        if (look_.is_flat) {
            draw_table();
        } else {
            ImGui::AlignTextToFramePadding();
            ImGui::TextDisabled("Stack");
            tooltip("Effects run from top to bottom. Drag one to move it, double-click to rename it.");
        }
        ImGui::SameLine(ImGui::GetContentRegionMax().x - buttons_width());
        if (state_.looks != nullptr) {
            draw_menu_button(looks_text, "looks",
                             "Takes another look in place of this one; undo brings this one back.");
            ImGui::SameLine();
        }
        draw_menu_button(add_text, "add", "Adds an effect at a place where it accepts the picture.");
        draw_add_menu(state_);
        draw_looks_menu(state_);
        ImGui::Spacing();
    }

    void draw_menu_button(const char* text, const char* menu, const char* help) {
        if (ImGui::Button(text)) {
            state_.filter.clear();
            state_.add_row = 0;
            ImGui::OpenPopup(menu);
        }
        state_.note(fmt::format("stack/{}", menu));
        tooltip(help);
    }

    static constexpr const char* looks_text = "Looks";
    static constexpr const char* add_text = "+  Add";
    [[nodiscard]] float buttons_width() const {
        const ImGuiStyle& style = ImGui::GetStyle();
        const auto width = [&](const char* text) { return ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x; };
        return width(add_text) + (state_.looks != nullptr ? width(looks_text) + style.ItemSpacing.x : 0);
    }

    /// What the flat table says of all of its effects.
    void draw_table() {
        const bool is_on = look_.is_enabled;
        if (icon_button("##table", is_on ? Icon::Shown : Icon::Hidden,
                        is_on ? "Switches off all effects but tone mapping and encoding."
                              : "Switches on all effects that start switched on.",
                        !is_on))
            state_.edit(is_on ? "all off" : "all on", [is_on](Look& look) {
                look.is_enabled = !is_on;
                return Result<>();
            });
        state_.note("stack/all");
        ImGui::SameLine();
        const float room = ImGui::GetContentRegionAvail().x - buttons_width() - ImGui::GetStyle().ItemSpacing.x;
        ImGui::SetNextItemWidth(std::min(9 * ImGui::GetFontSize(), room));
        const auto present = static_cast<std::size_t>(look_.order);
        if (ImGui::BeginCombo("##order", shown_name(order_names[present]).c_str())) {
            for (std::size_t i = 0; i < order_names.size(); ++i)
                if (ImGui::Selectable(shown_name(order_names[i]).c_str(), i == present) && i != present)
                    state_.edit("order", [i](Look& look) {
                        set_order(look, static_cast<LookOrder>(i));
                        return Result<>();
                    });
            ImGui::EndCombo();
        }
        tooltip(
            "The flat table: every effect, in this fixed order. Moving or copying one makes it a stack; of those that "
            "are "
            "off, it keeps those that were set.");
        state_.note("stack/order");
    }

    void draw_entry(std::size_t index, const std::string& next) {
        const LookEntry& entry = look_.entries[index];
        const std::string& name = names_[index];
        const bool is_on = entry.state.enabled.on != 0, is_selected = entry.id == state_.selected;
        ImGui::PushID(static_cast<int>(index));
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFrameHeight();
        const ImVec2 end{corner.x + width, corner.y + height};
        const bool is_under_mouse = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(corner, end);
        if (is_selected || is_under_mouse)
            ImGui::GetWindowDrawList()->AddRectFilled(corner, end,
                                                      ImGui::GetColorU32(ImGuiCol_Header, is_selected ? 1.0f : 0.4f),
                                                      ImGui::GetStyle().FrameRounding);
        if (is_selected && std::exchange(state_.scrolls_to_selected, false)) ImGui::SetScrollHereY();
        draw_switch(entry, name, is_on);
        ImGui::SameLine(0, 0);
        if (state_.renamed == name)
            draw_renaming(entry, name);
        else
            draw_name(entry, name, next, is_on);
        if (has_controls(entry)) draw_controls(entry, name);
        if (const std::string_view why = left_out(state_.plan, name); is_on && !why.empty()) draw_reason(why);
        ImGui::PopID();
    }

    /// Of its own: a flat table has no key for an opacity, and its order is fixed.
    [[nodiscard]] bool has_controls(const LookEntry& entry) const { return !look_.is_flat && !entry.is_of_ui; }
    static float opacity_width() { return ImGui::CalcTextSize("100 %").x + ImGui::GetStyle().FramePadding.x; }
    [[nodiscard]] float controls_width(const LookEntry& entry) const {
        return has_controls(entry) ? opacity_width() + 2 * ImGui::GetFrameHeight() : 0;
    }

    void draw_switch(const LookEntry& entry, const std::string& name, bool is_on) {
        const char* const help = is_on ? "Switches it off; with Alt, all others." : "Switches it on.";
        if (icon_button("##enabled", is_on ? Icon::Shown : Icon::Hidden, help, !is_on)) {
            if (ImGui::GetIO().KeyAlt)
                switch_others_off(entry.id, name);
            else
                state_.edit(fmt::format("{} {}", name, is_on ? "off" : "on"), [=](Look& look) {
                    const std::uint32_t on = is_on ? 0 : 1;
                    return edit::set_state(look, name, "enabled", {&on, 1});
                });
        }
        state_.note(fmt::format("stack/{}.enabled", name));
    }

    /// But those that take the picture to the display, without which nothing is to be judged.
    void switch_others_off(std::uint64_t id, const std::string& name) {
        state_.edit(fmt::format("{} alone", name), [id](Look& look) {
            for (LookEntry& other : look.entries)
                if (!is_domain_change(*other.effect)) other.state.enabled = other.id == id;
            return Result<>();
        });
    }

    void draw_name(const LookEntry& entry, const std::string& name, const std::string& next, bool is_on) {
        const float width = ImGui::GetContentRegionAvail().x - controls_width(entry);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float height = ImGui::GetFrameHeight();
        if (ImGui::InvisibleButton("##entry", {std::max(1.0f, width), height})) {
            state_.selected = entry.id;
            state_.part.reset();
        }
        state_.note(fmt::format("stack/{}", name));
        const bool is_hovered = ImGui::IsItemHovered();
        if (is_hovered && has_controls(entry) && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
            state_.renamed = state_.new_name = name;
            is_renaming_new_ = true;
        }
        const float pad = ImGui::GetStyle().ItemInnerSpacing.x;
        const std::string shown = shown_name(name), fitted = fitting(shown, width - 2 * pad, KeptPart::Start);
        tooltip(fmt::format("{}{}{}", fitted == shown ? "" : shown, fitted == shown ? "" : ": ", entry.effect->doc)
                    .c_str());
        drag(entry, name, next);
        ImGui::GetWindowDrawList()->AddText({corner.x + pad, corner.y + ImGui::GetStyle().FramePadding.y},
                                            ImGui::GetColorU32(is_on ? ImGuiCol_Text : ImGuiCol_TextDisabled),
                                            fitted.c_str());
        const float needed = ImGui::CalcTextSize(fitted.c_str()).x + ImGui::CalcTextSize(neutral).x + 4 * pad;
        if (!is_on || !is_neutral(entry) || needed > width) return;
        ImGui::GetWindowDrawList()->AddText(
            {corner.x + width - pad - ImGui::CalcTextSize(neutral).x, corner.y + ImGui::GetStyle().FramePadding.y},
            ImGui::GetColorU32(ImGuiCol_TextDisabled), neutral);
        state_.note(fmt::format("stack/{}.neutral", name));
    }

    static constexpr const char* neutral = "neutral";
    /// On, and of values that change nothing, unless something moves them.
    [[nodiscard]] bool is_neutral(const LookEntry& entry) const {
        const std::string& name = names_[static_cast<std::size_t>(&entry - look_.entries.data())];
        return entry.effect->is_identity != nullptr && entry.effect->is_identity(entry.words.data()) &&
               !is_moved(look_, name);
    }

    /// A line shows where it would go: before the entry under the mouse, or behind it.
    void drag(const LookEntry& entry, const std::string& name, const std::string& next) {
        if (entry.is_of_ui) return;
        if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoHoldToOpenOthers)) {
            ImGui::SetDragDropPayload(dragged_entry, &entry.id, sizeof(entry.id));
            ImGui::TextUnformatted(shown_name(name).c_str());
            ImGui::EndDragDropSource();
        }
        if (!ImGui::BeginDragDropTarget()) return;
        const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
        const bool is_before = ImGui::GetIO().MousePos.y < (least.y + most.y) / 2;
        constexpr ImGuiDragDropFlags flags =
            ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect;
        if (const ImGuiPayload* const payload = ImGui::AcceptDragDropPayload(dragged_entry, flags)) {
            const float thickness = std::max(2.0f, std::round(ImGui::GetFontSize() / 8));
            const float y = (is_before ? least.y : most.y) - thickness / 2;
            ImGui::GetWindowDrawList()->AddRectFilled({least.x, y}, {most.x, y + thickness},
                                                      ImGui::GetColorU32(accent_color));
            const std::uint64_t id = *static_cast<const std::uint64_t*>(payload->Data);
            if (payload->IsDelivery()) move(id, is_before ? name : next);
        }
        ImGui::EndDragDropTarget();
    }

    void move(std::uint64_t id, const std::string& before) {
        for (std::size_t i = 0; i < names_.size(); ++i) {
            if (look_.entries[i].id != id || names_[i] == before) continue;
            state_.selected = id;
            state_.part.reset();
            state_.edit(fmt::format("move {}", names_[i]),
                        [name = names_[i], before](Look& look) { return edit::move_entry(look, name, before); });
        }
    }

    void draw_renaming(const LookEntry& entry, const std::string& name) {
        ImGui::SetNextItemWidth(-controls_width(entry));
        if (is_renaming_new_) ImGui::SetKeyboardFocusHere();
        const bool is_done = text_field("##rename", "Name", state_.new_name,
                                        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        state_.note("stack/rename");
        if (is_done && state_.new_name != name)
            state_.edit(fmt::format("rename {}", name),
                        [name, wanted = state_.new_name, document = state_.document](Look& look) -> Result<> {
                            if (find_entry(look, wanted) != nullptr)
                                return user_error(fmt::format("{}: another entry has this name", printable(wanted)));
                            return edit::set_wire(look, name, "name", wanted, document->options());
                        });
        if (is_done || (ImGui::IsItemDeactivated() && !is_renaming_new_)) state_.renamed.clear();
        is_renaming_new_ &= !ImGui::IsItemActive();
    }

    void draw_controls(const LookEntry& entry, const std::string& name) {
        ImGui::SameLine(ImGui::GetContentRegionMax().x - controls_width(entry));
        float percent = entry.state.opacity * 100;
        const bool is_whole = percent == 100;
        ImGui::SetNextItemWidth(opacity_width());
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y});
        ImGui::PushStyleColor(ImGuiCol_Text,
                              ImGui::GetStyleColorVec4(is_whole ? ImGuiCol_TextDisabled : ImGuiCol_Text));
        ImGui::PushStyleColor(ImGuiCol_FrameBg, {0, 0, 0, 0});
        if (ImGui::DragFloat("##opacity", &percent, 0.5f, 0, 100, "%.0f %%", ImGuiSliderFlags_AlwaysClamp))
            state_.edit(
                fmt::format("{} opacity", name),
                [=](Look& look) {
                    const std::uint32_t word = std::bit_cast<std::uint32_t>(std::round(percent) / 100);
                    return edit::set_state(look, name, "opacity", {&word, 1});
                },
                fmt::format("{}.opacity", name));
        ImGui::PopStyleColor(2);
        ImGui::PopStyleVar();
        if (ImGui::IsItemActivated()) state_.document->end_merge();
        state_.note(fmt::format("stack/{}.opacity", name));
        tooltip("Share of its result that goes over its input: drag, or double-click and type.");
        ImGui::SameLine(0, 0);
        if (icon_button("##duplicate", Icon::Duplicate, "Puts a copy after it.", true))
            state_.edit(fmt::format("duplicate {}", name), [&state = state_, name](Look& look) -> Result<> {
                DARKROOM_TRY_VALUE(state.wanted, edit::duplicate_entry(look, name));
                return {};
            });
        state_.note(fmt::format("stack/{}.duplicate", name));
        ImGui::SameLine(0, 0);
        if (icon_button("##remove", Icon::Remove, "Takes it out of the stack.", true))
            state_.edit(fmt::format("remove {}", name), [name](Look& look) { return edit::remove_entry(look, name); });
        state_.note(fmt::format("stack/{}.remove", name));
    }

    static void draw_reason(std::string_view why) {
        const float indent = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + indent);
        ImGui::PushTextWrapPos(0);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextUnformatted(fmt::format("left out: {}", why).c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
    }

    PanelState& state_;
    const Look& look_;
    std::vector<std::string> names_;
    bool& is_renaming_new_ = state_.is_renaming_new;
};

}  // namespace

void draw_stack_panel(PanelState& state) {
    if (state.selected != 0) state.last_selected = state.selected;
    // Lines of a list stand closer together than those of a form.
    const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {spacing.x, std::round(spacing.y / 4)});
    StackList(state).draw();
    ImGui::PopStyleVar();
    state.settle();
}

}  // namespace darkroom::panels
