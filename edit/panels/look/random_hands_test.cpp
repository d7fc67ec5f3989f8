// SPDX-License-Identifier: MIT
// Hands that press anything: whatever they do, the look stays one that can be applied, and can be undone.
#include <gtest/gtest.h>

#include <darkroom/composer.hpp>
#include <darkroom/device.hpp>
#include <random>

#include "panels/look/test_look_panels.hpp"

namespace darkroom::panels {
namespace {

class RandomHands {
  public:
    RandomHands(TestPanels& own, unsigned seed) : own_(own), random_(seed) {}

    void act() {
        switch (number(10)) {
            case 0:
            case 1:
                own_.gui.click(place());
                break;
            case 2:
                own_.gui.click(place(), 1);
                break;
            case 3:
                own_.gui.double_click(place());
                break;
            case 4:
            case 5:
                own_.gui.drag(place(), place(), 3);
                break;
            case 6:
                own_.gui.type(
                    std::array{"1", "-3", "0.5", "9e9", "a", "_", "scene"}[static_cast<std::size_t>(number(7))]);
                break;
            case 7:
                own_.gui.key(std::array{ImGuiKey_Enter, ImGuiKey_Escape, ImGuiKey_Backspace,
                                        ImGuiKey_DownArrow}[static_cast<std::size_t>(number(4))]);
                break;
            case 8:
                ImGui::GetIO().MouseWheel = static_cast<float>(number(21) - 10);
                own_.gui.frame();
                ImGui::GetIO().MouseWheel = 0;
                break;
            default:
                own_.gui.control(true);
                own_.gui.click(place());
                own_.gui.control(false);
        }
        // Files of this machine are nobody's to play with.
        if (own_.panels.files().is_open()) own_.gui.key(ImGuiKey_Escape);
    }

  private:
    int number(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    /// Mostly on a widget.
    ImVec2 place() {
        const WidgetPlaces& places = own_.panels.places();
        if (number(4) == 0 || places.empty())
            return {static_cast<float>(number(1280)), static_cast<float>(number(720))};
        const WidgetPlace& widget = std::next(places.begin(), number(static_cast<int>(places.size())))->second;
        const float x = static_cast<float>(number(101)) / 100, y = static_cast<float>(number(101)) / 100;
        return {std::lerp(widget.least.x, widget.most.x, x), std::lerp(widget.least.y, widget.most.y, y)};
    }

    TestPanels& own_;
    std::mt19937 random_;
};

TEST(PanelRandomHands, LeaveALookThatCanBeApplied) {
    const Device device = Device::assumed();
    for (unsigned seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(seed);
        TestPanels own(seed % 2 == 0 ? default_look() : stack_of_all());
        RandomHands hands(own, seed);
        const std::string before = write_look(own.document.look());
        for (int i = 0; i < 250; ++i) {
            if (i % 10 == 0)
                own.select(own.names().empty() ? "" : own.names()[static_cast<std::size_t>(i) % own.names().size()]);
            hands.act();
            Composer composer(device);
            const Result<> done = apply(own.document.look(), composer);
            ASSERT_TRUE(done) << "after action " << i << ": " << done.error().text;
        }
        EXPECT_TRUE(own.document.can_undo());
        while (own.document.can_undo()) own.document.undo();
        EXPECT_EQ(write_look(own.document.look()), before);
    }
}

}  // namespace
}  // namespace darkroom::panels
