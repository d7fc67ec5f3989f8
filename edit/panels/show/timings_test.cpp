// SPDX-License-Identifier: MIT
#include "panels/show/timings.hpp"

#include <gtest/gtest.h>

#include "panels/test_gui.hpp"
#include "panels/widgets/plot.hpp"

namespace darkroom::panels {
namespace {

void add_frame(TimingHistory& history, std::uint64_t frame, const std::vector<PassTime>& passes, double record) {
    history.add({.frame_index = frame, .passes = passes}, record);
}

/// Bloom, a chain of small passes, and one frame that took longer.
TimingHistory chain(std::uint64_t frames) {
    TimingHistory history;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        const double wave = 0.1 * std::sin(static_cast<double>(frame) * 0.2), slow = frame == 150 ? 2 : 1;
        add_frame(history, frame,
                  {{"linear depth", 0.3},
                   {"ssao", (1.6 + wave) * slow},
                   {"ssao blur", 0.5},
                   {"bloom prefilter", 0.9 + wave},
                   {"bloom down 1", 0.25},
                   {"bloom down 2", 0.07},
                   {"bloom up 1", 0.2},
                   {"exposure, tonemap, vignette, encode, dither", 1.4 - wave}},
                  64 + 20 * wave);
    }
    return history;
}

class PanelTimings : public ::testing::Test {
  protected:
    static constexpr float width = 480, height = 420;

    PanelTimings() {
        gui.draw = [this] {
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({width, height});
            ImGui::Begin("timings", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize);
            panel.draw(history);
            ImGui::End();
        };
    }
    /// How wide this series is in the bar, in pixels; labels hide a part.
    [[nodiscard]] int bar_width(std::size_t series) const {
        const GuiPicture picture = gui.picture();
        const ImVec4 color = ImGui::ColorConvertU32ToFloat4(series_color(series));
        int found = 0;
        for (int x = 0; x < picture.width; ++x) {
            const std::uint8_t* const pixel = picture.at(x, bar_y);
            found += std::abs(pixel[0] - color.x * 255) < 2 && std::abs(pixel[2] - color.z * 255) < 2 ? 1 : 0;
        }
        return found;
    }

    static constexpr int bar_y = 37;  ///< near its upper edge, above the labels
    TestGui gui{width, height, 1};
    TimingHistory history;
    TimingsPanel panel;
};

TEST_F(PanelTimings, PassesShareTheBarAsTheyShareTheTime) {
    add_frame(history, 0, {{"a", 3}, {"b", 1}}, 50);
    gui.frame(2);
    EXPECT_NEAR(bar_width(0), 345, 3);
    EXPECT_NEAR(bar_width(1), 115, 3);
}

TEST_F(PanelTimings, APassUnderTheMouseStandsOut) {
    add_frame(history, 0, {{"a", 1}, {"b", 1}}, 50);
    gui.frame(2);
    gui.move({100, bar_y + 4});
    gui.frame(2);
    EXPECT_NEAR(bar_width(0), 230, 3);
    EXPECT_EQ(bar_width(1), 0) << "faded";
    gui.show("timings_pointed");
    gui.move({-1, -1});
    gui.frame(2);
    EXPECT_NEAR(bar_width(1), 230, 3);
}

TEST_F(PanelTimings, ShowsAHistoryAndATable) {
    history = chain(200);
    gui.frame(3);
    gui.show("timings");
    EXPECT_LT(ImGui::GetDrawData()->TotalVtxCount, 20'000);
    // The slow frame is the highest column, 50 columns from the right; the oldest ones are not there yet.
    const GuiPicture picture = gui.picture();
    const auto top = [&](int x) {
        for (int y = 60; y < 200; ++y)
            if (std::abs(picture.at(x, y)[0] - picture.at(x, y)[2]) > 15) return y;
        return 999;
    };
    const int slow = 10 + 460 * (40 + 150) / 240 + 1;
    EXPECT_LT(top(slow), top(slow - 20) - 10);
    EXPECT_LT(top(slow), top(slow + 20) - 10);
    EXPECT_EQ(top(60), 999);
    gui.move({static_cast<float>(slow), 150});
    gui.frame(2);
    gui.show("timings_frame");
}

TEST_F(PanelTimings, ManyPassesAreNotTooMuchForSmallIndices) {
    const std::vector<PassTime> passes(TimingHistory::max_passes, {"pass", 0.1});
    for (std::uint64_t frame = 0; frame < TimingHistory::max_frames; ++frame) add_frame(history, frame, passes, 1);
    gui.frame(2);
    EXPECT_LT(ImGui::GetDrawData()->CmdLists[0]->VtxBuffer.Size, 60'000);
}

TEST_F(PanelTimings, SaysSoWhereThereIsNothing) {
    const auto said = [&] {
        gui.draw = [&, drawn = gui.draw] {
            ImGui::LogToClipboard();
            drawn();
            ImGui::LogFinish();
        };
        gui.frame(2);
        return gui.clipboard;
    };
    EXPECT_NE(said().find("No times yet."), std::string::npos) << gui.clipboard;
    history = chain(3);
    EXPECT_NE(said().find("GPU"), std::string::npos) << gui.clipboard;
    history.clear();
    EXPECT_NE(said().find("No times yet."), std::string::npos) << gui.clipboard;
}

TEST_F(PanelTimings, TimesOfNothingAreNoTrouble) {
    add_frame(history, 0, {{"a", 0}, {"b", 0}}, 0);
    gui.move({100, bar_y});
    gui.frame(3);
    gui.move({400, 120});
    gui.frame(3);
}

}  // namespace
}  // namespace darkroom::panels
