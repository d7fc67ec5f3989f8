// SPDX-License-Identifier: MIT
#pragma once
// The panels as a host lays them out, for tests: the stack above the entry's parameters, and the plan beside them.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <string>

#include "edit/document.hpp"
#include "panels/panels.hpp"
#include "panels/test_gui.hpp"

namespace darkroom::panels {

class TestPanels {
  public:
    explicit TestPanels(Look look, ImVec2 size = {1280, 720}, float scale = 1)
        : document(std::move(look)), panels(document), gui(size.x, size.y, scale) {
        static_cast<void>(panels.places());
        // Every value has a line; what holds wheels takes this back.
        panels.show_numbers(true);
        gui.draw = [this, size, scale] { draw(size, scale); };
        gui.frame(2);
    }

    edit::LookDocument document;
    LookPanels panels;
    TestGui gui;

    [[nodiscard]] bool has(std::string_view widget) { return panels.places().contains(widget); }
    [[nodiscard]] WidgetPlace place(std::string_view widget) {
        const auto found = panels.places().find(widget);
        EXPECT_NE(found, panels.places().end()) << "no widget " << widget;
        return found == panels.places().end() ? WidgetPlace{} : found->second;
    }
    void click(std::string_view widget) { gui.click(place(widget).center()); }
    void select(std::string_view entry) {
        panels.select(entry);
        gui.frame(2);
    }
    [[nodiscard]] const LookEntry& entry(std::string_view name) const {
        Look& look = const_cast<Look&>(document.look());
        const LookEntry* const found = find_entry(look, name);
        EXPECT_NE(found, nullptr) << name;
        return *found;
    }
    [[nodiscard]] std::vector<std::string> names() const { return entry_names(document.look()); }

  private:
    void draw(ImVec2 size, float scale) {
        constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                           ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;
        const float width = 296 * scale, half = size.y * 0.45f;
        const auto window = [&](const char* name, ImVec2 corner, ImVec2 extent, void (LookPanels::*content)()) {
            ImGui::SetNextWindowPos(corner);
            ImGui::SetNextWindowSize(extent);
            ImGui::Begin(name, nullptr, flags);
            (panels.*content)();
            ImGui::End();
        };
        const float bar = 70 * scale;
        window("Look", {0, 0}, {width, bar}, &LookPanels::draw_bar);
        window("Stack", {0, bar}, {width, half - bar}, &LookPanels::draw_stack);
        window("Parameters", {0, half}, {width, size.y - half}, &LookPanels::draw_entry);
        window("Plan", {size.x - width, 0}, {width, half}, &LookPanels::draw_plan);
        if (!panels.messages().is_empty()) {
            const float room = size.x - 2 * width;
            const float height = panels.messages().height(room - 20 * scale) + 50 * scale;
            window("Messages", {width, size.y - height}, {room, height}, &LookPanels::draw_messages);
        }
        panels.draw_popups();
    }
};

/// A stack of every effect of this build, each with its name.
[[nodiscard]] inline Look stack_of_all() {
    Look look{.is_flat = false, .shown_name = "all.toml"};
    for (const EffectInfo* const effect : all_effects()) {
        const std::span<const std::uint32_t> defaults = effect->parameters.defaults;
        look.entries.push_back({.effect = effect, .words = {defaults.begin(), defaults.end()}});
    }
    return look;
}

}  // namespace darkroom::panels
