// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/recursive_blend.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "develop/test_sequence.hpp"

namespace darkroom {
namespace {

using test::developed_sequence;
using test::reference_sequence;
using test::Shot;

test::Fill stack_of(const RecursiveBlend& blend) {
    return [blend](Composer& composer) { composer.add(blend); };
}

/// The first frame, then another picture for `frames` frames.
std::vector<Shot> changing(const ReferenceImage& first, const ReferenceImage& then, std::size_t frames,
                           double delta_time = 1.0 / 60) {
    std::vector<Shot> shots{{.color = first, .delta_time = delta_time}};
    shots.insert(shots.end(), frames, {.color = then, .delta_time = delta_time});
    return shots;
}

const ReferenceImage white = test::uniform(5, 3, {1, 1, 1, 1}), black = test::uniform(5, 3, {0, 0, 0, 1});

TEST(EffectRecursiveBlend, GpuMatchesReference) {
    std::vector<Shot> shots;
    for (std::uint32_t i = 0; i < 6; ++i)
        shots.push_back(
            {.color = test::round_to_float(test::random_hdr(33, 17, i)), .delta_time = i < 3 ? 0.01 : 0.03});
    const RecursiveBlend blend{.weight = 0.7f};
    const std::vector<ReferenceImage> expected = reference_sequence(stack_of(blend), shots);
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
        const std::vector<ReferenceImage> out = developed_sequence(stack_of(blend), shots, kernels);
        // A product and a sum in floats of up to 60000, in each of six frames.
        for (std::size_t i = 0; i < shots.size(); ++i)
            EXPECT_LE(test::worst_difference(out[i], expected[i]), 60000 * 0x1p-21) << i;
    }
}

TEST(EffectRecursiveBlend, GpuMatchesReferenceInEightBits) {
    std::vector<Shot> shots;
    for (std::uint32_t i = 0; i < 6; ++i) shots.push_back({.color = test::random_display(33, 17, i)});
    const RecursiveBlend blend{.weight = 0.7f, .precision = RecursiveBlendPrecision::EightBit};
    const std::vector<ReferenceImage> expected = reference_sequence(stack_of(blend), shots);
    const std::vector<ReferenceImage> out = developed_sequence(stack_of(blend), shots);
    // Steps of 1/255, in floats.
    for (std::size_t i = 0; i < shots.size(); ++i) EXPECT_LE(test::worst_difference(out[i], expected[i]), 1e-6) << i;
}

TEST(EffectRecursiveBlend, LightFadesByItsWeight) {
    const std::vector<ReferenceImage> out = reference_sequence(stack_of({.weight = 0.8f}), changing(white, black, 10));
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i].at(2, 1).g, std::pow(0.8, i), 1e-6);
}

TEST(EffectRecursiveBlend, LooksTheSameAtAnyFrameRate) {
    const RecursiveBlend blend{.weight = 0.9f};
    const auto after_a_quarter = [&](std::size_t frames) {
        const double delta_time = 0.25 / static_cast<double>(frames);
        return developed_sequence(stack_of(blend), changing(white, black, frames, delta_time)).back().at(1, 1).r;
    };
    const double expected = std::pow(0.9, 15);
    // The exponent is exact; each frame rounds once.
    EXPECT_NEAR(after_a_quarter(36), expected, 1e-5) << "144 frames a second";
    EXPECT_NEAR(after_a_quarter(15), expected, 1e-5);
    EXPECT_NEAR(after_a_quarter(8), expected, 1e-5) << "32 frames a second";
    EXPECT_NEAR(after_a_quarter(6), expected, 1e-5);
}

TEST(EffectRecursiveBlend, EightBitsLeaveAGhostAndFloatsDoNot) {
    constexpr std::pair<float, int> ghosts[] = {{0.5f, 1}, {0.8f, 2}, {0.9f, 5}, {0.95f, 10}};
    for (const auto& [weight, code] : ghosts) {
        const auto left = [weight = weight](RecursiveBlendPrecision precision) {
            const RecursiveBlend blend{.weight = weight, .precision = precision};
            return developed_sequence(stack_of(blend), changing(white, black, 400)).back().at(2, 2).r * 255;
        };
        EXPECT_NEAR(left(RecursiveBlendPrecision::EightBit), code, 1e-4) << weight;
        EXPECT_LT(left(RecursiveBlendPrecision::Float), 1e-4) << weight;
    }
}

// A host that is paused, or a structure of zeros: as after the 1/60 s that weights are told for.
TEST(EffectRecursiveBlend, AFrameAfterNoTimeFadesAsOneAfterASixtieth) {
    std::vector<Shot> shots = changing(white, black, 4);
    shots[2].delta_time = shots[3].delta_time = 0;
    for (const std::vector<ReferenceImage>& out :
         {developed_sequence(stack_of({.weight = 0.8f}), shots), reference_sequence(stack_of({.weight = 0.8f}), shots)})
        for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i].at(2, 1).g, std::pow(0.8, i), 1e-6) << i;
}

TEST(EffectRecursiveBlend, TheFirstFrameAndTheFirstAfterACutAreThePicture) {
    std::vector<Shot> cut = changing(white, black, 3), jump = cut, standstill = cut;
    cut[2].camera.is_cut = true;
    jump[2].camera.view[12] = 31;  // metres
    standstill[2].delta_time = -1;
    for (const std::vector<Shot>& shots : {cut, jump, standstill})
        for (const std::vector<ReferenceImage>& out :
             {developed_sequence(stack_of({}), shots), reference_sequence(stack_of({}), shots)}) {
            EXPECT_EQ(test::worst_difference(out[0], white), 0);
            EXPECT_NEAR(out[1].at(0, 0).r, 0.8, 1e-6);
            EXPECT_EQ(test::worst_difference(out[2], black), 0);
            EXPECT_EQ(test::worst_difference(out[3], black), 0);
        }
}

TEST(EffectRecursiveBlend, NanAndInfinityDoNotComeBack) {
    ReferenceImage broken = white;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    broken.at(2, 1) = {nan, infinity, -infinity, 1};
    const RecursiveBlend blend{.weight = 0.5f};
    const std::vector<ReferenceImage> out = developed_sequence(stack_of(blend), changing(broken, white, 40));
    EXPECT_EQ(out[0].at(2, 1).r, 0);
    EXPECT_EQ(out[0].at(2, 1).g, 65504);
    EXPECT_NEAR(out[1].at(2, 1).r, 0.5, 1e-6);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (const Rgba& pixel : out[i].pixels)
            EXPECT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b)) << i;
    EXPECT_LE(test::worst_difference(out.back(), white), 1e-6) << "65504 / 2^40";
}

TEST(EffectRecursiveBlend, WeightZeroChangesNothing) {
    const RecursiveBlend off{.weight = 0}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

TEST(EffectRecursiveBlend, PreRollIsShorterWhereFramesAreFartherApart) {
    const RecursiveBlend blend;
    const EffectInfo& info = effect_info(blend);
    EXPECT_EQ(info.pre_roll(&blend, 1.0 / 60), 28u) << "0.8^28 = 0.0019";
    EXPECT_EQ(info.pre_roll(&blend, 1.0 / 30), 14u);
    EXPECT_EQ(info.pre_roll(&blend, 1.0 / 120), 56u);
}

TEST(EffectRecursiveBlend, OddSizesAndASinglePixel) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{7, 1}, VkExtent2D{3, 11}}) {
        const ReferenceImage first = test::random_display(extent.width, extent.height, 1),
                             then = test::random_display(extent.width, extent.height, 2);
        const std::vector<Shot> shots = changing(first, then, 2);
        EXPECT_LE(test::worst_difference(developed_sequence(stack_of({}), shots)[2],
                                         reference_sequence(stack_of({}), shots)[2]),
                  1e-6);
    }
}

}  // namespace
}  // namespace darkroom
