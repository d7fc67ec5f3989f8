// SPDX-License-Identifier: MIT
#include "panels/widgets/messages.hpp"

#include <gtest/gtest.h>

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
    for (int i = 0; i < 100; ++i) messages.report(std::to_string(i), {Fault::User, "no"});
    EXPECT_EQ(messages.texts().size(), 16u);
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
