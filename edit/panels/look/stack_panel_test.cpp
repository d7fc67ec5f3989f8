// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "edit/edits.hpp"
#include "panels/look/test_look_panels.hpp"
#include "panels/panel_state.hpp"

namespace darkroom::panels {
namespace {

const ImVec2 tall_panel{1280, 4000};

using Names = std::vector<std::string>;

/// From the middle of one entry to just above another.
void drag_before(TestPanels& own, const std::string& entry, const std::string& other) {
    const WidgetPlace to = own.place("stack/" + other);
    own.gui.drag(own.place("stack/" + entry).center(), {to.center().x, to.least.y + 3});
}

TEST(PanelStack, DragsReorder) {
    TestPanels own(stack_of_all(), tall_panel);
    const Names before = own.names();
    ASSERT_GE(before.size(), 5u);
    drag_before(own, before[4], before[1]);
    Names moved = before;
    std::rotate(moved.begin() + 1, moved.begin() + 4, moved.begin() + 5);
    EXPECT_EQ(own.names(), moved);
    EXPECT_EQ(own.panels.selected(), before[4]);
    // Behind the last.
    const WidgetPlace last = own.place("stack/" + moved.back());
    own.gui.drag(own.place("stack/" + moved[0]).center(), {last.center().x, last.most.y - 3});
    Names behind = moved;
    std::rotate(behind.begin(), behind.begin() + 1, behind.end());
    EXPECT_EQ(own.names(), behind);
    own.panels.undo();
    EXPECT_EQ(own.names(), moved);
    own.click("bar/undo");
    EXPECT_EQ(own.names(), before);
    own.click("bar/redo");
    EXPECT_EQ(own.names(), moved);
    // Onto itself: nothing.
    const std::uint64_t version = own.document.version();
    drag_before(own, moved[2], moved[2]);
    EXPECT_EQ(own.document.version(), version);
}

TEST(PanelStack, SwitchesCopiesAndRemoves) {
    TestPanels own(stack_of_all(), tall_panel);
    const Names before = own.names();
    const std::string name = before[2];
    own.click("stack/" + name + ".enabled");
    EXPECT_EQ(own.entry(name).state.enabled.on, 0u);
    own.click("stack/" + name + ".enabled");
    EXPECT_EQ(own.entry(name).state.enabled.on, 1u);
    own.gui.drag(own.place("stack/" + name + ".opacity").center(), {0, 0});
    EXPECT_LT(own.entry(name).state.opacity, 1);
    const std::size_t count = before.size();
    own.click("stack/" + name + ".duplicate");
    EXPECT_EQ(own.document.look().entries.size(), count + 1);
    EXPECT_EQ(own.panels.selected(), own.names()[3]);
    own.click("stack/" + own.panels.selected() + ".remove");
    EXPECT_EQ(own.names(), before);
    EXPECT_EQ(own.panels.selected(), "");
    EXPECT_EQ(own.document.undo_name(), "remove " + name + "#2");
    while (own.document.can_undo()) own.click("bar/undo");
    EXPECT_FALSE(own.document.is_changed());
    EXPECT_EQ(own.entry(name).state.opacity, 1);
}

TEST(PanelStack, AltSwitchesAllOthersOff) {
    TestPanels own(default_look(), tall_panel);
    std::string name;
    for (const LookEntry& entry : own.document.look().entries)
        if (entry.state.enabled.on != 0 && entry.effect->build) name = entry.effect->name;
    if (name.empty()) GTEST_SKIP() << "no effect of this build is on and has passes";
    own.click("stack/" + name + ".enabled");
    own.gui.alt(true);
    own.click("stack/" + name + ".enabled");
    own.gui.alt(false);
    for (const LookEntry& entry : own.document.look().entries)
        EXPECT_TRUE(entry.state.enabled.on == (entry.effect->name == name) || entry.effect->makes != nullptr)
            << entry.effect->name;
    own.panels.undo();
    own.panels.undo();
    EXPECT_FALSE(own.document.is_changed());
}

TEST(PanelStack, DoubleClickRenames) {
    TestPanels own(stack_of_all(), tall_panel);
    const std::string name = own.names()[1];
    const auto rename = [&](const std::string& from, std::string_view to) {
        own.gui.double_click(own.place("stack/" + from).center());
        own.gui.frame(2);
        own.gui.type(to);
        own.gui.key(ImGuiKey_Enter);
        own.gui.frame(2);
    };
    rename(name, "glow");
    EXPECT_EQ(own.names()[1], "glow");
    EXPECT_TRUE(own.has("stack/glow"));
    rename("glow", own.names()[2]);
    EXPECT_EQ(own.names()[1], "glow");
    EXPECT_FALSE(own.panels.messages().is_empty());
}

TEST(PanelStack, FlatTablesBecomeStacksWhereTheirOrderChanges) {
    TestPanels own(default_look(), tall_panel);
    Names on;
    for (const LookEntry& entry : own.document.look().entries)
        if (!entry.is_of_ui && entry.state.enabled.on != 0) on.emplace_back(entry.effect->name);
    ASSERT_GE(on.size(), 2u);
    EXPECT_FALSE(own.has(fmt::format("stack/{}.opacity", on[0])));
    own.click("stack/all");
    EXPECT_FALSE(own.document.look().is_enabled);
    own.click("stack/all");
    EXPECT_TRUE(own.document.look().is_flat);
    own.click("stack/" + on[0]);
    EXPECT_EQ(own.panels.selected(), on[0]);
    drag_before(own, on[0], on[1]);
    EXPECT_FALSE(own.document.look().is_flat);
    EXPECT_EQ(own.panels.selected(), on[0]);
    EXPECT_TRUE(own.has(fmt::format("stack/{}.opacity", on[0])));
    own.panels.undo();
    EXPECT_TRUE(own.document.look().is_flat);
}

TEST(PanelStack, AddsWhatIsSearchedFor) {
    Look look = stack_of_all();
    const EffectInfo* const wanted = look.entries[1].effect;
    look.entries.erase(look.entries.begin() + 1);
    TestPanels own(std::move(look), tall_panel);
    own.click("stack/add");
    own.gui.frame(2);
    std::size_t offered = 0;
    for (const EffectInfo* const effect : all_effects()) offered += own.has(fmt::format("add/{}", effect->name));
    EXPECT_EQ(offered, all_effects().size());
    std::string text(wanted->doc.substr(0, wanted->doc.size() - 1));
    own.gui.type(text);
    own.gui.key(ImGuiKey_Enter);
    own.gui.frame(2);
    EXPECT_EQ(own.panels.selected(), wanted->name);
    EXPECT_EQ(own.document.undo_name(), fmt::format("add {}", wanted->name));
    own.panels.undo();
    EXPECT_EQ(own.panels.selected(), "");
}

// Every effect but one has a place in the flat table.
TEST(PanelStack, AddingKeepsAFlatTableOrAsks) {
    for (const EffectInfo* const effect : all_effects()) {
        if (effect->flat.is_of_ui()) continue;
        TestPanels own(default_look(), tall_panel);
        const Look before = own.document.look();
        const auto add = [&] {
            own.click("stack/add");
            own.gui.frame(2);
            own.gui.type(effect->doc.substr(0, effect->doc.size() - 1));
            own.gui.key(ImGuiKey_Enter);
            own.gui.frame(2);
        };
        const auto kind = edit::addition_of(before, *effect).kind;
        EXPECT_NE(kind, edit::Addition::Kind::Inserts) << effect->name;
        add();
        if (kind == edit::Addition::Kind::SwitchesOn) {
            EXPECT_TRUE(own.document.look().is_flat) << effect->name;
            EXPECT_EQ(own.entry(effect->name).state.enabled.on, 1U) << effect->name;
            EXPECT_EQ(own.panels.selected(), effect->name);
            continue;
        }
        EXPECT_TRUE(own.has("question/0")) << effect->name << " becomes a stack without a question";
        EXPECT_FALSE(own.document.is_changed()) << effect->name;
        own.click("question/cancel");
        EXPECT_FALSE(own.document.is_changed()) << effect->name;
        add();
        own.click(kind == edit::Addition::Kind::IsThere ? "question/1" : "question/0");
        own.gui.frame(2);
        EXPECT_FALSE(own.document.look().is_flat) << effect->name;
    }
}

TEST(PanelStack, PulsesAndLayersComeAndGo) {
    if (find_effect("bloom") == nullptr) GTEST_SKIP() << "this build has no effect bloom";
    TestPanels own(stack_of_all(), tall_panel);
    own.select("bloom");
    const auto make = [&](const std::string& button, const std::string& name) {
        own.click(button);
        own.gui.frame(2);
        own.gui.type(name);
        own.click("mover/add");
        own.gui.frame(2);
    };
    make("stack/add_pulse", "hit");
    ASSERT_EQ(own.document.look().pulses.size(), 1U);
    EXPECT_EQ(own.document.look().pulses[0].event, "hit");
    EXPECT_EQ(own.document.look().pulses[0].entry, "bloom");
    EXPECT_EQ(own.document.undo_name(), "add pulse hit");
    EXPECT_TRUE(own.has("fire/hit")) << "it is selected";
    own.click("mover/remove");
    EXPECT_TRUE(own.document.look().pulses.empty());
    own.panels.undo();
    EXPECT_EQ(own.document.look().pulses.size(), 1U);

    make("stack/add_pulse", "no name");
    EXPECT_EQ(own.document.look().pulses.size(), 1U) << "it cannot be added";
    own.gui.key(ImGuiKey_Escape);
    own.gui.frame(2);

    make("stack/add_layer", "night");
    ASSERT_EQ(own.document.look().layers.size(), 1U);
    own.click("layer/add_value");
    own.gui.frame(2);
    own.click("mover/add");
    own.gui.frame(2);
    EXPECT_EQ(own.document.look().layers[0].values.size(), 1U) << "it has this one already";
    EXPECT_FALSE(own.panels.messages().is_empty());
    own.click("layer/distance");
    own.gui.frame(2);
    EXPECT_TRUE(own.document.look().layers[0].distance);
    EXPECT_TRUE(own.has("layer/night.near"));
    own.click("layer/distance");
    own.gui.frame(2);
    EXPECT_FALSE(own.document.look().layers[0].distance);
    own.click("mover/remove");
    EXPECT_TRUE(own.document.look().layers.empty());
    while (own.document.can_undo()) own.document.undo();
    EXPECT_FALSE(own.document.is_changed());
}

TEST(PanelStack, AsksForPicturesOfEffectsThatAreSeen) {
    TestPanels own(stack_of_all(), tall_panel);
    std::map<std::string_view, int> asked;
    own.panels.set_thumbnails([&](const EffectInfo& effect) {
        ++asked[effect.name];
        return Thumbnail{.aspect = 2};
    });
    own.gui.frame(2);
    EXPECT_TRUE(asked.empty());
    EXPECT_FALSE(own.panels.is_adding());
    own.click("stack/add");
    own.gui.frame(2);
    EXPECT_TRUE(own.panels.is_adding());
    EXPECT_GT(asked.size(), 3U);
    EXPECT_LT(asked.size(), std::max<std::size_t>(all_effects().size() / 2, 20)) << "the others are not seen";
    for (const auto& [name, count] : asked) {
        const WidgetPlace place = own.place(fmt::format("add/{}.picture", name));
        EXPECT_NEAR(place.most.x - place.least.x, 2 * (place.most.y - place.least.y), 1) << name;
    }
    own.gui.key(ImGuiKey_Escape);
    own.gui.frame(2);
    asked.clear();
    own.gui.frame(2);
    EXPECT_TRUE(asked.empty());
    EXPECT_FALSE(own.panels.is_adding());
}

TEST(PanelStack, AnotherLookIsOneStep) {
    const std::string text = "[[stack]]\neffect = \"exposure\"\n";
    TestPanels own(stack_of_all(), tall_panel);
    const Names before = own.names();
    std::map<std::string, int> asked;
    own.panels.set_looks({.files = {"shipped/broken.toml", "shipped/night.toml"},
                          .read = [&](const std::filesystem::path& file) -> Result<Look> {
                              if (file.stem() == "broken") return user_error("broken.toml:1:1: is no look");
                              return parse_look(text, "night.toml");
                          },
                          .picture =
                              [&](const std::filesystem::path& file) {
                                  ++asked[file.stem().string()];
                                  const bool is_broken = file.stem() == "broken";
                                  return Thumbnail{.aspect = 2,
                                                   .error = is_broken ? "broken.toml:1:1: is no look" : ""};
                              }});
    own.gui.frame(2);
    EXPECT_TRUE(asked.empty());
    own.click("stack/looks");
    own.gui.frame(2);
    EXPECT_TRUE(own.panels.is_adding());
    EXPECT_EQ(asked.size(), 2U);
    EXPECT_TRUE(own.has("looks/night.picture"));
    EXPECT_FALSE(own.has("looks/broken.picture")) << "its line stands there instead";
    own.click("looks/night");
    own.gui.frame(2);
    EXPECT_EQ(own.names(), Names{"exposure"});
    EXPECT_FALSE(own.panels.is_adding());
    EXPECT_TRUE(own.document.is_changed());
    EXPECT_EQ(own.document.undo_name(), "look night");
    own.panels.undo();
    EXPECT_EQ(own.names(), before);
    EXPECT_FALSE(own.document.can_undo());
    own.gui.frame(2);
    own.click("stack/looks");
    own.gui.frame(2);
    own.gui.key(ImGuiKey_Enter);
    own.gui.frame(2);
    EXPECT_EQ(own.names(), before) << "the first cannot be read";
    EXPECT_FALSE(own.panels.messages().is_empty());
    own.click("stack/looks");
    own.gui.frame(2);
    own.gui.key(ImGuiKey_DownArrow);
    own.gui.key(ImGuiKey_Enter);
    own.gui.frame(2);
    EXPECT_EQ(own.names(), Names{"exposure"});
}

TEST(PanelStack, ArrowsAndEnterAdd) {
    TestPanels own(stack_of_all(), tall_panel);
    const std::size_t before = own.names().size();
    own.click("stack/add");
    own.gui.frame(2);
    own.gui.key(ImGuiKey_Escape);
    own.gui.frame(2);
    own.gui.key(ImGuiKey_Enter);
    EXPECT_EQ(own.names().size(), before) << "Escape closes it";
    own.click("stack/add");
    own.gui.frame(2);
    own.gui.key(ImGuiKey_DownArrow);
    own.gui.key(ImGuiKey_DownArrow);
    own.gui.key(ImGuiKey_UpArrow);
    own.gui.key(ImGuiKey_Enter);
    own.gui.frame(2);
    EXPECT_EQ(own.names().size(), before + 1);
    EXPECT_NE(own.panels.selected(), "");
}

TEST(PanelStack, SaysWhatChangesNothing) {
    TestPanels own(default_look(), tall_panel);
    std::size_t neutral = 0;
    for (const LookEntry& entry : own.document.look().entries) {
        if (entry.is_of_ui) continue;
        const bool is_neutral = entry.state.enabled.on != 0 && entry.effect->is_identity != nullptr &&
                                entry.effect->is_identity(entry.words.data());
        EXPECT_EQ(own.has(fmt::format("stack/{}.neutral", entry.effect->name)), is_neutral) << entry.effect->name;
        neutral += is_neutral ? 1 : 0;
    }
    EXPECT_GT(neutral, 0U);
}

TEST(PanelStack, TellsWhatIsLeftOutAndWhy) {
    Plan plan;
    EXPECT_EQ(left_out(nullptr, "a"), "");
    plan.left_out = {"glow#2: needs depth, which the frame does not have"};
    EXPECT_EQ(left_out(&plan, "glow"), "");
    EXPECT_EQ(left_out(&plan, "glow#2"), "needs depth, which the frame does not have");
    TestPanels own(stack_of_all(), tall_panel);
    const Names names = own.names();
    const float before = own.place("stack/" + names[1]).least.y;
    plan.left_out = {names[0] + ": needs depth, which the frame does not have"};
    own.panels.set_plan(&plan);
    own.gui.frame(2);
    EXPECT_GE(own.place("stack/" + names[1]).least.y, before + ImGui::GetFontSize());
    own.click("stack/" + names[0] + ".enabled");
    EXPECT_EQ(own.place("stack/" + names[1]).least.y, before);
}

// Nothing is lost of what is written: every glyph lies in the part of the window that is drawn, but for lists that are
// scrolled up and down.
TEST(PanelStack, NothingIsCutOff) {
    for (const float scale : {1.0f, 2.5f}) {
        Look look = stack_of_all();
        look.entries[0].name = std::string(64, 'w');
        TestPanels own(std::move(look), scale == 1 ? ImVec2(1280, 720) : ImVec2(3840, 2160), scale);
        Plan plan;
        for (const std::string& name : own.names()) {
            plan.left_out.push_back(name + ": needs depth and velocity, which the frame does not have");
            plan.passes.push_back({.name = name + "+" + name, .extent = {3840, 2160}});
        }
        own.panels.set_plan(&plan);
        // So that nothing but letters is drawn from the atlas.
        ImGui::GetStyle().AntiAliasedLinesUseTex = false;
        own.panels.messages().report("edit", {Fault::User,
                                              "/a/long/path/to/the/look/that/was/read.toml:12:13: bloom_"
                                              "intensity = -1: allowed is [0, 16]"});
        for (const std::string& name : own.names()) {
            own.select(name);
            const ImDrawData& data = *ImGui::GetDrawData();
            const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
            for (int i = 0; i < data.CmdListsCount; ++i) {
                const ImDrawList& list = *data.CmdLists[i];
                for (const ImDrawCmd& command : list.CmdBuffer)
                    for (unsigned k = 0; k < command.ElemCount; ++k) {
                        const ImDrawVert& vertex =
                            list.VtxBuffer[list.IdxBuffer[static_cast<int>(command.IdxOffset + k)]];
                        if (vertex.uv.x == white.x && vertex.uv.y == white.y) continue;
                        ASSERT_GE(vertex.pos.x, command.ClipRect.x - 1) << name;
                        ASSERT_LE(vertex.pos.x, command.ClipRect.z + 1) << name;
                    }
            }
        }
        own.gui.show(fmt::format("full_{}", scale));
    }
}

}  // namespace
}  // namespace darkroom::panels
