// SPDX-License-Identifier: MIT
// Wheels, curves and groups of an effect with many colours, held by a mouse.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "edit/effect_uses.hpp"
#include "panels/look/entry_rows.hpp"
#include "panels/look/test_look_panels.hpp"

namespace darkroom::panels {
namespace {

/// The effect that has wheels, if this build has one.
const EffectInfo* wheeled() {
    const auto found = std::ranges::find_if(all_effects(), [](const auto* each) { return !groups_of(*each).empty(); });
    return found == all_effects().end() ? nullptr : *found;
}
const RowGroup& group_of(const std::vector<RowGroup>& groups, RowGroup::Kind kind) {
    const auto found = std::ranges::find(groups, kind, &RowGroup::kind);
    EXPECT_NE(found, groups.end());
    return *found;
}

class PanelGrade : public testing::Test {
  protected:
    void SetUp() override {
        effect_ = wheeled();
        if (effect_ == nullptr) GTEST_SKIP() << "this build has no effect with wheels";
        const std::span<const std::uint32_t> defaults = effect_->parameters.defaults;
        Look look{.is_flat = false, .shown_name = "one.toml"};
        look.entries.push_back({.effect = effect_, .words = {defaults.begin(), defaults.end()}});
        own_ = std::make_unique<TestPanels>(std::move(look), ImVec2{1280, 4800});
        own_->panels.show_numbers(false);
        own_->select(effect_->name);
        groups_ = groups_of(*effect_);
    }
    [[nodiscard]] std::array<float, 3> numbers(const ParamInfo& row) const {
        std::array<float, 3> out{};
        const std::vector<std::uint32_t>& words = own_->entry(effect_->name).words;
        for (std::size_t i = 0; i < 3; ++i) out[i] = std::bit_cast<float>(words[row.word + i]);
        return out;
    }
    [[nodiscard]] std::string widget(const ParamInfo& row) const {
        return fmt::format("{}.{}", effect_->name, row.name);
    }
    /// The middle of the disc: the slider is below it.
    [[nodiscard]] ImVec2 disc(const ParamInfo& row) {
        const WidgetPlace place = own_->place(widget(row));
        const float radius = (place.most.x - place.least.x) / 2;
        return {place.least.x + radius, place.least.y + radius};
    }

    const EffectInfo* effect_ = nullptr;
    std::unique_ptr<TestPanels> own_;
    std::vector<RowGroup> groups_;
};

TEST_F(PanelGrade, EveryRowIsInOneGroupAndPlainNumbersComeFirst) {
    std::size_t rows = 0;
    for (const RowGroup& group : groups_) rows += group.rows.size();
    EXPECT_EQ(rows, effect_->parameters.rows.size());
    EXPECT_EQ(groups_.front().kind, RowGroup::Kind::Lines);
    own_->gui.show("grade");
}

TEST_F(PanelGrade, TheDiscParksWhereColoursLieOnAVectorscope) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int i = 0; i < 200; ++i) {
        const std::array<double, 3> rgb{number(random), number(random), number(random)};
        const double mean = (rgb[0] + rgb[1] + rgb[2]) / 3;
        const std::array<double, 3> again = wheel_color(wheel_place(rgb), mean);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(again[k], rgb[k], 1e-12);
    }
    const auto [red_x, red_y] = wheel_place({1, 0, 0});
    EXPECT_LT(red_x, 0);
    EXPECT_GT(red_y, 0);
    const auto [x, y] = wheel_place({0.7, 0.7, 0.7});
    EXPECT_NEAR(std::hypot(x, y), 0, 1e-12) << "grey is in the middle";
}

TEST_F(PanelGrade, ADragOnTheDiscMovesColourAndKeepsTheMean) {
    const ParamInfo& row = *group_of(groups_, RowGroup::Kind::Wheels).rows[0];
    const std::array<float, 3> before = numbers(row);
    const ImVec2 middle = disc(row);
    own_->gui.drag(middle, {middle.x - 8, middle.y - 24});
    const std::array<float, 3> now = numbers(row);
    EXPECT_GT(now[0], before[0]) << "up and to the left is red";
    EXPECT_LT(now[1] + now[2], before[1] + before[2]);
    EXPECT_NEAR(now[0] + now[1] + now[2], before[0] + before[1] + before[2], 2e-3);
    own_->document.undo();
    EXPECT_EQ(numbers(row), before) << "a drag is one step";
    own_->gui.drag(middle, {middle.x + 20, middle.y});
    own_->gui.double_click(middle);
    const std::array<float, 3> grey = numbers(row);
    EXPECT_NEAR(grey[0], grey[1], 1e-6);
    EXPECT_NEAR(grey[0], grey[2], 1e-6);
}

TEST_F(PanelGrade, AClickOnTheDiscMovesNothing) {
    const ParamInfo& row = *group_of(groups_, RowGroup::Kind::Wheels).rows[0];
    const ImVec2 middle = disc(row);
    own_->gui.click({middle.x + 15, middle.y + 4});
    EXPECT_FALSE(own_->document.can_undo());
}

TEST_F(PanelGrade, OneCurveMovesAllChannelsAndEachCanDiffer) {
    const RowGroup& group = group_of(groups_, RowGroup::Kind::Curves);
    const std::string name = fmt::format("{}/{}", effect_->name, group.name);
    const auto points = [&](std::size_t channel) {
        return own_->entry(effect_->name).words[group.rows[channel]->word];
    };
    own_->gui.click(own_->place(name + ".plot").center());
    for (std::size_t channel = 0; channel < 3; ++channel) EXPECT_EQ(points(channel), 1U) << channel;
    own_->click(name + ".Red");
    own_->gui.frame(2);
    const WidgetPlace plot = own_->place(widget(*group.rows[0]));
    own_->gui.click({plot.least.x + 20, plot.least.y + 30});
    EXPECT_EQ(points(0), 2U);
    EXPECT_EQ(points(1), 1U);
    own_->panels.undo();
    own_->panels.undo();
    for (std::size_t channel = 0; channel < 3; ++channel) EXPECT_EQ(points(channel), 0U) << channel;
}

TEST_F(PanelGrade, NumbersAreThereForWhoWantsThem) {
    EXPECT_FALSE(own_->has(widget(*group_of(groups_, RowGroup::Kind::Channels).rows[0]))) << "it is folded";
    own_->click(fmt::format("{}/numbers", effect_->name));
    own_->gui.frame(2);
    for (const ParamInfo& row : effect_->parameters.rows) EXPECT_TRUE(own_->has(widget(row))) << row.name;
}

TEST(EffectPurpose, EveryEffectHasOne) {
    for (const EffectInfo* const effect : all_effects())
        EXPECT_NE(edit::purpose_of(*effect), "") << effect->name << ": its page has no line 'Purpose: ...'";
    for (const std::string_view purpose : edit::purposes)
        EXPECT_TRUE(std::ranges::any_of(all_effects(), [&](const auto* effect) {
            return edit::purpose_of(*effect) == purpose;
        })) << purpose;
}

}  // namespace
}  // namespace darkroom::panels
