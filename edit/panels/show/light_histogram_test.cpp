// SPDX-License-Identifier: MIT
#include "panels/show/light_histogram.hpp"

#include "panels/look/test_look_panels.hpp"

namespace darkroom::panels {
namespace {

/// 256 bins of an eighth of a stop from -16: half of all at -2 stops, half at 4; metered from 3 to 5.
std::vector<float> two_lights() {
    std::vector<float> numbers{-16, 0.125f, 3, 5, 4, -4};
    numbers.resize(6 + 256);
    numbers[6 + 14 * 8] = numbers[6 + 20 * 8] = 0.5f;
    return numbers;
}

TEST(PanelLightHistogram, IsWhatAnEffectTellsOrNothing) {
    EXPECT_FALSE(light_histogram_of({}));
    EXPECT_FALSE(light_histogram_of(std::vector<float>(6 + 256))) << "before the first frame";
    EXPECT_FALSE(light_histogram_of(std::vector<float>(4, 1.0f)));
    const std::vector<float> numbers = two_lights();
    const auto histogram = light_histogram_of(numbers);
    ASSERT_TRUE(histogram);
    EXPECT_EQ(histogram->shares.size(), 256u);
    EXPECT_EQ(histogram->low, 3);
    EXPECT_EQ(histogram->high, 5);
    EXPECT_EQ(histogram->metered, 4);
    EXPECT_EQ(histogram->added, -4);
}

TEST(PanelLightHistogram, BinsStandWhereTheirStopsAreAndWhatCountsIsBright) {
    TestGui gui(532, 240, 1);
    const std::vector<float> numbers = two_lights();
    const LightHistogram histogram = *light_histogram_of(numbers);
    gui.draw = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
        ImGui::Begin("light", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize);
        draw_light_histogram(histogram);
        ImGui::End();
    };
    gui.frame(2);
    const GuiPicture picture = gui.picture();
    // Eight stops about middle grey, four pixels a bin, behind a padding of ten.
    const auto at = [&](float stops, int channel) {
        return static_cast<int>(picture.at(10 + static_cast<int>((stops + 8) * 32) + 1, 60)[channel]);
    };
    EXPECT_GT(at(-2, 1), at(-3, 1) + 30) << "outside, dim";
    EXPECT_GT(at(3.5f, 0), at(-3, 0) + 20) << "the window";
    EXPECT_GT(at(4, 0), at(3.5f, 0) + 30) << "inside, bright";
    EXPECT_GT(at(4, 1), at(-2, 1) + 20);
}

TEST(PanelLightHistogram, StandsOverTheParametersOfTheEffectThatTells) {
    if (find_effect("exposure") == nullptr || find_effect("vignette") == nullptr) GTEST_SKIP() << "they are not built";
    const std::vector<float> numbers = two_lights();
    TestPanels own(stack_of_all());
    own.select("exposure");
    EXPECT_FALSE(own.has("exposure.histogram"));
    own.panels.set_numbers([&](std::string_view name) {
        return name == "exposure.histogram" ? std::span<const float>(numbers) : std::span<const float>();
    });
    own.gui.frame(2);
    ASSERT_TRUE(own.has("exposure.histogram"));
    EXPECT_LT(own.place("exposure.histogram").most.y, own.place("exposure.exposure").most.y);
    own.select("vignette");
    EXPECT_FALSE(own.has("vignette.histogram"));
}

}  // namespace
}  // namespace darkroom::panels
