// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/frame_blend.hpp>
#include <limits>
#include <vector>

#include "develop/test_sequence.hpp"

namespace darkroom {
namespace {

using test::developed_sequence;
using test::reference_sequence;
using test::Shot;

test::Fill stack_of(const FrameBlend& blend) {
    return [blend](Composer& composer) { composer.add(blend); };
}

/// `picture_at` a time, from 0 to `seconds`.
template <class Function>
std::vector<Shot> shots_of(double frames_per_second, double seconds, const Function& picture_at) {
    std::vector<Shot> shots;
    const auto count = static_cast<int>(std::lround(seconds * frames_per_second));
    for (int i = 0; i <= count; ++i)
        shots.push_back({.color = picture_at(i / frames_per_second),
                         .time = i / frames_per_second,
                         .delta_time = 1 / frames_per_second});
    return shots;
}

ReferenceImage grey(double value, std::uint32_t width = 8, std::uint32_t height = 8) {
    return test::uniform(width, height, {value, value, value, 1});
}

TEST(EffectFrameBlend, GpuMatchesReference) {
    for (const FrameBlendArea area : {FrameBlendArea::Quarter, FrameBlendArea::Sixteenth})
        for (const double rate : {24.0, 60.0, 144.0}) {
            SCOPED_TRACE(rate);
            const FrameBlend blend{.amount = 0.7f, .frames = 5, .area = area};
            std::uint32_t number = 0;
            const std::vector<Shot> shots = shots_of(
                rate, 0.15, [&](double) { return test::round_to_float(test::random_display(37, 22, ++number)); });
            const std::vector<ReferenceImage> expected = reference_sequence(stack_of(blend), shots);
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
                const std::vector<ReferenceImage> out = developed_sequence(stack_of(blend), shots, kernels);
                // Small pictures and their sum are cut off to half precision, each by up to 2^-10.
                for (std::size_t i = 0; i < shots.size(); ++i)
                    EXPECT_LE(test::worst_difference(out[i], expected[i]), 0x1p-9) << i;
            }
        }
}

TEST(EffectFrameBlend, WeightsDecreaseAndEnd) {
    // A flash of one frame at 60 frames a second.
    const FrameBlend blend{.amount = 0.5f, .frames = 7};
    const std::vector<Shot> shots =
        shots_of(60, 0.5, [](double time) { return grey(std::abs(time - 0.2) < 1e-6 ? 1.0 : 0.0); });
    for (const std::vector<ReferenceImage>& out :
         {developed_sequence(stack_of(blend), shots), reference_sequence(stack_of(blend), shots)}) {
        const auto at = [&](std::size_t frame) { return out[frame].at(3, 3).r; };
        EXPECT_EQ(at(11), 0);
        EXPECT_NEAR(at(12), 0.5, 1e-3);
        double sum = 0;
        for (std::size_t i = 13; i <= 19; ++i) {
            EXPECT_GT(at(i), 0);
            if (i > 13) {
                EXPECT_LT(at(i), at(i - 1)) << i;
            }
            sum += at(i);
        }
        EXPECT_NEAR(sum, 0.5, 2e-3) << "all weights together";
        for (std::size_t i = 20; i < out.size(); ++i) EXPECT_EQ(at(i), 0) << "no ghost in frame " << i;
    }
}

TEST(EffectFrameBlend, LooksTheSameAtAnyFrameRate) {
    // Light that grows evenly, by 2 a second: a picture tells how old its trail is.
    constexpr double slope = 2;
    const FrameBlend blend{.amount = 0.6f, .frames = 7};
    const auto age = [&](double rate) {
        const std::vector<Shot> shots = shots_of(rate, 0.5, [](double time) { return grey(slope * time); });
        const double shown = developed_sequence(stack_of(blend), shots).back().at(4, 4).r;
        return (shots.back().color.at(4, 4).r - shown) / slope / double{blend.amount};
    };
    const double at_60 = age(60);
    EXPECT_NEAR(at_60, 2.9 / 60, 0.1 / 60);
    for (const double rate : {30.0, 72.0, 120.0, 144.0}) EXPECT_NEAR(age(rate), at_60, 0.5 / 60) << rate;
}

TEST(EffectFrameBlend, StillPicturesStayAndCutsDarkenNothing) {
    // Wide flat areas, so that small copies hold the same.
    std::vector<Shot> shots = shots_of(60, 0.3, [](double) { return grey(0.75); });
    shots[5].camera.is_cut = true;
    for (const ReferenceImage& out : developed_sequence(stack_of({}), shots))
        EXPECT_LE(test::worst_difference(out, grey(0.75)), 0x1p-9);
    std::vector<Shot> cut = shots_of(60, 0.3, [](double time) { return grey(time < 0.15 ? 1 : 0.25); });
    cut[9].camera.is_cut = true;
    const std::vector<ReferenceImage> out = developed_sequence(stack_of({}), cut);
    EXPECT_EQ(test::worst_difference(out[9], grey(0.25)), 0) << "nothing of the time before";
    EXPECT_LE(test::worst_difference(out[12], grey(0.25)), 0x1p-10);
}

TEST(EffectFrameBlend, WhereTimeStandsStillThereIsNoTrail) {
    std::vector<Shot> shots;
    for (int i = 0; i < 12; ++i) shots.push_back({.color = grey(i == 3 ? 1 : 0)});
    const std::vector<ReferenceImage> out = developed_sequence(stack_of({.amount = 0.5f}), shots);
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(test::worst_difference(out[i], shots[i].color), 0) << i;
}

TEST(EffectFrameBlend, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    std::vector<Shot> shots = shots_of(60, 0.25, [](double) { return grey(0.5, 33, 19); });
    shots[2].color.at(16, 8) = {nan, infinity, -infinity, 1};
    const std::vector<ReferenceImage> out = developed_sequence(stack_of({}), shots);
    for (std::size_t i = 3; i < out.size(); ++i)
        for (std::uint32_t y = 0; y < 19; ++y)
            for (std::uint32_t x = 0; x < 33; ++x) {
                const Rgba& pixel = out[i].at(x, y);
                ASSERT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b)) << i;
                // A small texel, the one it is sampled between, and half of each.
                if (std::abs(static_cast<int>(x) - 16) > 10) {
                    EXPECT_NEAR(pixel.g, 0.5, 1e-3) << i;
                }
            }
    EXPECT_LE(test::worst_difference(out.back(), grey(0.5, 33, 19)), 0x1p-10) << "and it ends";
}

TEST(EffectFrameBlend, OddSizesAndASinglePixel) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{3, 1}, VkExtent2D{7, 11}}) {
        std::uint32_t number = 0;
        const std::vector<Shot> shots = shots_of(60, 0.1, [&](double) {
            return test::round_to_float(test::random_display(extent.width, extent.height, ++number));
        });
        EXPECT_LE(test::worst_difference(developed_sequence(stack_of({}), shots).back(),
                                         reference_sequence(stack_of({}), shots).back()),
                  0x1p-9);
    }
}

// A trail lasts as long in seconds at every frame rate.
TEST(EffectFrameBlend, PreRollCoversTheTrailAtEveryFrameRate) {
    const FrameBlend blend;
    const double trail = static_cast<double>(blend.frames + 1) / 60;
    for (const double frames_per_second : {24.0, 60.0, 144.0, 240.0, 1000.0}) {
        const double covered = effect_info(blend).pre_roll(&blend, 1 / frames_per_second) / frames_per_second;
        EXPECT_GE(covered, trail) << frames_per_second;
        EXPECT_LE(covered, trail + 2.001 / frames_per_second) << frames_per_second;
    }
}

TEST(EffectFrameBlend, AmountZeroChangesNothing) {
    const FrameBlend off{.amount = 0}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

}  // namespace
}  // namespace darkroom
