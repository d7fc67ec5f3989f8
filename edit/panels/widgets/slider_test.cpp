// SPDX-License-Identifier: MIT
#include "panels/widgets/slider.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects.hpp>

namespace darkroom::panels {
namespace {

TEST(PanelSlider, EveryScaleGoesFromEndToEnd) {
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows) {
            if (row.range.min >= row.range.max) continue;
            const double usual = std::bit_cast<float>(effect->parameters.defaults[row.word]);
            const SliderScale scale(row.range, row.kind == Kind::Float ? usual : 0);
            EXPECT_DOUBLE_EQ(scale.value(0), row.range.min) << effect->name << ' ' << row.name;
            EXPECT_NEAR(scale.value(1), row.range.max, std::abs(row.range.max) * 1e-12)
                << effect->name << ' ' << row.name;
            double before = row.range.min;
            for (int i = 1; i <= 100; ++i) {
                const double value = scale.value(i / 100.0);
                EXPECT_GT(value, before) << effect->name << ' ' << row.name << " at " << i;
                EXPECT_NEAR(scale.position(value), i / 100.0, 1e-9) << effect->name << ' ' << row.name;
                before = value;
            }
        }
}

TEST(PanelSlider, WideIntervalsLeaveRoomAboutTheDefault) {
    const SliderScale light({0, 65504}, 1);
    EXPECT_GT(light.position(1), 0.1);
    EXPECT_GT(light.position(2) - light.position(1), 0.02);
    const SliderScale both({-256, 256}, 0);
    EXPECT_NEAR(both.position(0), 0.5, 1e-12);
    EXPECT_NEAR(both.position(-6) + both.position(6), 1, 1e-12);
    const SliderScale ratios({0.25, 4, Scale::Log}, 1);
    EXPECT_NEAR(ratios.position(1), 0.5, 1e-12);
    // Of the blades of an aperture, none at first, four lie before the middle.
    const SliderScale counts({0, 11}, 0, true);
    EXPECT_NEAR(counts.value(0.37), 4.07, 1e-9);
    const SliderScale even({0, 1}, 0.5);
    EXPECT_NEAR(even.position(0.25), 0.25, 1e-12);
}

TEST(PanelSlider, FourDigits) {
    EXPECT_EQ(four_digits(0), 0);
    EXPECT_DOUBLE_EQ(four_digits(0.123456), 0.1235);
    EXPECT_DOUBLE_EQ(four_digits(-65432.1), -65430);
    EXPECT_DOUBLE_EQ(four_digits(1e-7), 1e-7);
}

}  // namespace
}  // namespace darkroom::panels
