// SPDX-License-Identifier: MIT
#include "panels/widgets/messages.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "panels/test_gui.hpp"

namespace darkroom::panels {
namespace {

TEST(PanelMessages, StayUntilTheirSourceSucceedsOrTheyArePutAway) {
    Messages messages;
    EXPECT_FALSE(messages.settle("save", user_error("a.toml:1:2: no")));
    EXPECT_FALSE(messages.settle("reload", user_error("b.toml:3:4: no")));
    EXPECT_FALSE(messages.settle("save", user_error("a.toml:5:6: no")));
    EXPECT_EQ(messages.texts(), (std::vector<std::string>{"b.toml:3:4: no", "a.toml:5:6: no"}));
    EXPECT_TRUE(messages.settle("reload", {}));
    EXPECT_EQ(messages.texts(), (std::vector<std::string>{"a.toml:5:6: no"}));
    for (int i = 0; i < 100; ++i) messages.report(std::to_string(i), {Fault::User, fmt::format("no {}", i)});
    EXPECT_EQ(messages.texts().size(), 16u);
}

TEST(PanelMessages, WhatNoLongerHoldsGoesIntoTheHistory) {
    Messages messages;
    using Said = Messages::Said;
    const Said wrong{Severity::Error, "a.toml:1:2: no"}, odd{Severity::Warning, "a.toml:3:1: unknown key 'b'"};
    messages.say("reload", std::array{wrong, odd});
    messages.say("scene", std::array{wrong});
    EXPECT_EQ(messages.texts(), (std::vector{wrong.text, odd.text})) << "one text of two sources is one message";
    EXPECT_EQ(messages.take_new(), (std::vector{wrong, odd}));
    messages.say("reload", std::array{wrong, odd});
    EXPECT_TRUE(messages.take_new().empty()) << "said again, it is nothing new";
    EXPECT_EQ(messages.count(Severity::Error), 1U);
    EXPECT_EQ(messages.count(Severity::Warning), 1U);
    messages.say("reload", std::array{odd});
    EXPECT_EQ(messages.texts(), (std::vector{wrong.text, odd.text})) << "the scene still says it";
    messages.clear("scene");
    EXPECT_EQ(messages.texts(), std::vector{odd.text});
    messages.clear("reload");
    EXPECT_TRUE(messages.is_empty());
    ASSERT_EQ(messages.history().size(), 2U);
    messages.report("reload", {Fault::User, wrong.text});
    EXPECT_EQ(messages.take_new(), std::vector{wrong}) << "what comes again is told again";
    EXPECT_EQ(messages.history().back().count, 2U);
    messages.note("saved a.toml");
    messages.note("saved a.toml");
    EXPECT_EQ(messages.history().back().count, 2U);
    EXPECT_EQ(messages.texts(), std::vector{wrong.text});
}

TEST(PanelMessages, PlacesBeginThem) {
    EXPECT_EQ(place_in("a/b.toml:3:14: unknown"), (TextPlace{"a/b.toml", 3, 14}));
    EXPECT_EQ(place_in("a:b.glsl:7: 'x' : undeclared"), (TextPlace{"a:b.glsl", 7, 0}));
    for (const char* const text : {"a.toml: there is no such file", "a:0: b", ":3: b", "contrast = 3:4", ""})
        EXPECT_FALSE(place_in(text)) << text;
}

TEST(PanelMessages, AClickChoosesThePlaceWhereThereIsSuchAFile) {
    TestGui gui(640, 480, 1);
    const std::filesystem::path folder = testing::TempDir();
    std::ofstream(folder / "darkroom_message.toml") << "a = 1\n";
    Messages messages;
    messages.set_folder(folder);
    messages.report("a", {Fault::User, "darkroom_message.toml:1:3: no"});
    messages.report("b", {Fault::User, "darkroom_missing.toml:1:3: no"});
    std::map<std::string, ImVec2> places;
    gui.draw = [&] {
        ImGui::SetNextWindowSize({500, 400});
        ImGui::Begin("Messages");
        messages.draw([&](std::string_view name) {
            const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
            places[std::string(name)] = {(least.x + most.x) / 2, (least.y + most.y) / 2};
        });
        ImGui::End();
    };
    gui.frame(2);
    gui.click(places["message/1"]);
    EXPECT_FALSE(messages.take_chosen());
    gui.click(places["message/0"]);
    EXPECT_EQ(messages.take_chosen(), (TextPlace{folder / "darkroom_message.toml", 1, 3}));
}

TEST(PanelMessages, TakeTheHeightTheySay) {
    TestGui gui(640, 480, 1);
    Messages messages;
    for (const int length : {5, 60, 190}) {
        std::string text;
        while (static_cast<int>(text.size()) < length) text += "word ";
        messages.report(std::to_string(length), {Fault::User, text});
    }
    float height = 0, said = 0;
    gui.draw = [&] {
        ImGui::SetNextWindowSize({300, 400});
        ImGui::Begin("Messages");
        const float before = ImGui::GetCursorPosY();
        said = messages.height(ImGui::GetContentRegionAvail().x);
        messages.draw();
        height = ImGui::GetCursorPosY() - before;
        ImGui::End();
    };
    gui.frame(2);
    EXPECT_EQ(height, said);
    EXPECT_GT(height, 7 * ImGui::GetFontSize());
}

}  // namespace
}  // namespace darkroom::panels
