// SPDX-License-Identifier: MIT
#include "panels/show/plan_picture.hpp"

#include <gtest/gtest.h>

#include "panels/test_gui.hpp"

namespace darkroom::panels {
namespace {

constexpr std::uint64_t mebibyte = 1 << 20;

PlanImage transient(std::string name, std::uint64_t bytes, std::uint64_t offset, std::uint32_t first,
                    std::uint32_t last) {
    return {.name = std::move(name),
            .kind = PlanImage::Kind::Transient,
            .extent = {960, 540},
            .bytes = bytes,
            .offset = offset,
            .first_pass = first,
            .last_pass = last};
}

/// Five passes; "half" and "blurred" share memory, and the trail is a history.
Plan example() {
    Plan plan{.extent = {1920, 1080}};
    plan.images = {
        {.name = "color", .kind = PlanImage::Kind::Host, .extent = {1920, 1080}, .first_pass = 0, .last_pass = 4},
        {.name = "target", .kind = PlanImage::Kind::Host, .extent = {1920, 1080}, .first_pass = 4, .last_pass = 4},
        {.name = "trail",
         .kind = PlanImage::Kind::History,
         .extent = {1920, 1080},
         .bytes = 16 * mebibyte,
         .first_pass = 3,
         .last_pass = 3},
        transient("half", 4 * mebibyte, 0, 0, 1),
        transient("quarter", mebibyte, 4 * mebibyte, 1, 2),
        transient("blurred", 3 * mebibyte, 0, 2, 4),
        transient("mean", 4, 5 * mebibyte, 0, 4),
        {.name = "unused"}};
    plan.passes = {{.name = "bright",
                    .stage = "compute",
                    .entries = {"bloom"},
                    .boundary = "the first",
                    .reads = {{0}},
                    .writes = {3}},
                   {.name = "down", .stage = "compute", .entries = {"bloom"}, .reads = {{3}}, .writes = {4}},
                   {.name = "blur", .stage = "compute", .entries = {"bloom"}, .reads = {{4}}, .writes = {5}},
                   {.name = "trail", .stage = "compute", .entries = {"blend"}, .reads = {{2, 0, true}}, .writes = {2}},
                   {.name = "tonemap, encode",
                    .stage = "raster",
                    .entries = {"tonemap", "encode"},
                    .reads = {{0}, {5}, {2}},
                    .writes = {1}}};
    plan.transient_bytes = 5 * mebibyte + 4;
    plan.transient_bytes_unaliased = 8 * mebibyte + 4;
    plan.left_out = {"ssao: needs depth, which is not given"};
    return plan;
}

const PlanLayout::Bar& bar_of(const Plan& plan, const PlanLayout& layout, std::string_view name) {
    for (const PlanLayout::Bar& bar : layout.bars)
        if (plan.images[bar.image].name == name) return bar;
    ADD_FAILURE() << "no bar for " << name;
    return layout.bars.front();
}

TEST(PanelPlanPicture, BarsSpanThePassesInWhichImagesLive) {
    const Plan plan = example();
    const PlanLayout layout = lay_out(plan, {500, 400}, 20);
    EXPECT_EQ(layout.bars.size(), 7U) << "what no pass uses has none";
    EXPECT_EQ(layout.column_width, 100);
    for (const PlanLayout::Bar& bar : layout.bars) {
        const PlanImage& image = plan.images[bar.image];
        EXPECT_EQ(bar.min.x, static_cast<float>(image.first_pass * 100)) << image.name;
        EXPECT_EQ(bar.max.x, static_cast<float>(image.last_pass * 100 + 100)) << image.name;
        EXPECT_GE(bar.min.y, layout.header_height) << image.name;
        EXPECT_LE(bar.max.y, layout.size.y) << image.name;
        EXPECT_EQ(image.kind == PlanImage::Kind::Transient, bar.min.y >= layout.memory_top) << image.name;
    }
}

TEST(PanelPlanPicture, HeightAndPlaceAreThoseInMemory) {
    const Plan plan = example();
    const PlanLayout layout = lay_out(plan, {500, 600}, 20);
    const float pixels_a_mebibyte = (layout.size.y - layout.memory_top) / 5;
    const PlanLayout::Bar &half = bar_of(plan, layout, "half"), &quarter = bar_of(plan, layout, "quarter"),
                          &blurred = bar_of(plan, layout, "blurred"), &mean = bar_of(plan, layout, "mean");
    EXPECT_NEAR(half.max.y - half.min.y, 4 * pixels_a_mebibyte, 0.01f);
    EXPECT_NEAR(blurred.max.y - blurred.min.y, 3 * pixels_a_mebibyte, 0.01f);
    EXPECT_EQ(half.min.y, blurred.min.y);
    EXPECT_NEAR(quarter.min.y, half.max.y, 0.01f);
    EXPECT_GE(mean.max.y - mean.min.y, 3) << "small ones stay visible";
}

TEST(PanelPlanPicture, GrowsWhereManyImagesHaveARow) {
    Plan plan = example();
    for (int i = 0; i < 50; ++i) plan.images.push_back(plan.images[2]);
    const PlanLayout layout = lay_out(plan, {500, 100}, 20);
    EXPECT_GT(layout.size.y, 1000);
    for (const PlanLayout::Bar& bar : layout.bars) EXPECT_LE(bar.max.y, layout.size.y);
    EXPECT_EQ(lay_out(Plan{}, {500, 400}, 20).bars.size(), 0U);
}

class PanelPlanPictureGui : public ::testing::Test {
  protected:
    PanelPlanPictureGui() {
        gui.draw = [this] {
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({640, 480});
            ImGui::Begin("plan", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize);
            draw_plan_picture(plan);
            ImGui::End();
        };
        gui.frame(3);
    }
    /// Pixels in the accent's colour, in this column of the picture and below the passes' rows.
    [[nodiscard]] int marked(int column) const {
        const GuiPicture picture = gui.picture();
        const int left = 10 + column * 124 + 30, right = left + 64;
        int found = 0;
        for (int y = 70; y < 86; ++y)
            for (int x = left; x < right; ++x)
                found += std::abs(picture.at(x, y)[0] - accent_color.x * 255) < 2 &&
                                 std::abs(picture.at(x, y)[2] - accent_color.z * 255) < 2
                             ? 1
                             : 0;
        return found;
    }

    Plan plan = example();
    TestGui gui{640, 480, 1};
};

TEST_F(PanelPlanPictureGui, AnImageUnderTheMouseShowsWhoWritesAndReadsIt) {
    gui.show("plan");
    for (int column = 0; column < 5; ++column) EXPECT_EQ(marked(column), 0) << column;
    // In the memory's upper left corner lies "half".
    gui.move({40, 200});
    gui.frame(2);
    gui.show("plan_image");
    EXPECT_GT(marked(0), 60) << "a full mark for the pass that writes";
    EXPECT_GT(marked(1), 10);
    EXPECT_LT(marked(1), 60) << "an open one for the pass that reads";
    for (int column = 2; column < 5; ++column) EXPECT_EQ(marked(column), 0) << column;
}

TEST_F(PanelPlanPictureGui, APassUnderTheMouseSaysWhatItIs) {
    const GuiPicture before = gui.picture();
    gui.move({570, 45});
    gui.frame(2);
    gui.show("plan_pass");
    EXPECT_NE(gui.picture().rgba, before.rgba);
}

TEST_F(PanelPlanPictureGui, NeighboursOfOneEffectShareATitle) {
    const auto title_row = [&] {
        std::vector<int> row;
        const GuiPicture picture = gui.picture();
        for (int x = 130; x < 140; ++x) row.push_back(picture.at(x, 36)[0]);
        return row;
    };
    plan.passes[0].name = "bloom.bright";
    plan.passes[1].name = "bloom.down";
    gui.frame(2);
    const auto shared = title_row();
    plan.passes[1].name = "blur.down";
    gui.frame(2);
    EXPECT_NE(title_row(), shared) << "one title ends, and another begins";
}

TEST_F(PanelPlanPictureGui, AnEmptyPlanIsDrawn) {
    plan = {};
    gui.move({300, 100});
    gui.frame(3);
}

}  // namespace
}  // namespace darkroom::panels
