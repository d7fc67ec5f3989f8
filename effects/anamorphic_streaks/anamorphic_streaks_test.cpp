// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/anamorphic_streaks.hpp>

#include "anamorphic_streaks/anamorphic_streaks_reference.hpp"
#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "shared/test_lamp.hpp"
#include "shared/test_no_numbers.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const AnamorphicStreaks& streaks, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(streaks); }, picture, {.kernels = kernels});
}

/// A light of 4x4 pixels, which are a texel of the small picture, at column `x` of that.
ReferenceImage lamp(std::uint32_t width, std::uint32_t x, double light) {
    ReferenceImage picture(width, 64, {0, 0, 0, 1});
    for (std::uint32_t dy = 0; dy < 4; ++dy)
        for (std::uint32_t dx = 0; dx < 4; ++dx) picture.at(4 * x + dx, 32 + dy) = {light, light, light, 1};
    return picture;
}

// The product of the steps' kernels is the exponential, texel by texel.
TEST(EffectAnamorphicStreaks, TheStepsMakeAnExponential) {
    constexpr std::size_t reach = anamorphic_streaks_reach;
    for (const double decay : {0.3, 0.9, 0.97, 0.995}) {
        std::vector<double> side(reach, 0.0);
        side[0] = 1;
        for (std::uint32_t step = 0; step < anamorphic_streaks_steps; ++step) {
            const auto weights = anamorphic_streaks_weights(decay, step);
            std::vector<double> next(reach, 0.0);
            for (std::size_t i = 0; i < reach; ++i)
                for (std::size_t k = 0; k < 4 && k << 2 * step <= i; ++k)
                    next[i] += weights[k] * side[i - (k << 2 * step)];
            side = next;
        }
        double sum = 0;
        for (std::size_t i = 0; i < reach; ++i) {
            sum += side[i];
            EXPECT_NEAR(side[i] * anamorphic_streaks_side(decay), std::pow(decay, i), 1e-12) << decay << ", " << i;
        }
        EXPECT_NEAR(sum, 1, 1e-12) << "it holds the light that it is given";
    }
}

TEST(EffectAnamorphicStreaks, AStreakLiesOnItsLineAndFallsToOneInEOfItsLength) {
    // 1080 / 64 pixels of 1080 lines are one of 64.
    const AnamorphicStreaks streaks{.intensity = 1, .length = 20.0f * 1080 / 64, .tint = {1, 0.5f, 0}};
    const ReferenceImage picture = lamp(256, 32, 101), out = developed(streaks, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    // Between texel centres the small picture is linear: at them, it is the formula.
    const auto green = [&](std::uint32_t x) { return (out.at(x + 1, 33).g + out.at(x + 2, 33).g) / 2; };
    for (const std::uint32_t x : {140u, 160u, 180u, 200u})
        EXPECT_NEAR(green(x + 20) / green(x), std::exp(-1), 0.01) << x;
    for (const std::uint32_t x : {140u, 172u})
        EXPECT_NEAR(green(x) / green(2 * 128 - x), 1, 0.01) << "both sides are the same";
    EXPECT_NEAR(out.at(180, 33).r / out.at(180, 33).g, 2, 0.01);
    EXPECT_EQ(out.at(180, 33).b, 0);
    for (const std::uint32_t y : {0u, 26u, 41u, 63u}) EXPECT_EQ(out.at(180, y).g, 0) << y;
}

TEST(EffectAnamorphicStreaks, ItHoldsTheLightThatItIsGiven) {
    const AnamorphicStreaks streaks{.intensity = 1, .length = 8.0f * 1080 / 64, .tint = {1, 1, 1}};
    const ReferenceImage picture = lamp(512, 64, 101), out = test::reference_of(streaks, picture);
    double added = 0;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) added += out.pixels[i].g - picture.pixels[i].g;
    EXPECT_NEAR(added / (16 * 100), 1, 1e-3);
}

// What lies outside is black: a light on the edge loses what falls there, and is not repeated.
TEST(EffectAnamorphicStreaks, TheEdgeIsNotRepeated) {
    const AnamorphicStreaks streaks{.intensity = 1, .length = 8.0f * 1080 / 64, .tint = {1, 1, 1}};
    const ReferenceImage edge = developed(streaks, lamp(256, 0, 101)), middle = developed(streaks, lamp(256, 32, 101));
    ASSERT_EQ(edge.pixels.size(), middle.pixels.size());
    for (const std::uint32_t x : {10u, 30u, 60u})
        EXPECT_NEAR(edge.at(x, 33).g / middle.at(x + 128, 33).g, 1, 0.01) << x;
}

/// Light up to 3, which is above the threshold nearly everywhere.
ReferenceImage lights(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::random_display(width, height, 62);
    for (Rgba& color : picture.pixels) color = {3 * color.r, 3 * color.g, 3 * color.b, color.a};
    return test::round_to_float(picture);
}

TEST(EffectAnamorphicStreaks, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{128u, 72u}, {131u, 67u}, {1u, 1u}, {9u, 2u}})
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            for (const AnamorphicStreaks& streaks : {AnamorphicStreaks{.intensity = 1, .length = 512},
                                                     AnamorphicStreaks{.intensity = 1, .threshold = 0.3f}}) {
                const ReferenceImage picture = lights(width, height);
                const ReferenceImage expected = test::reference_of(streaks, picture);
                const ReferenceImage out = developed(streaks, picture, kernels);
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                // Five writes in half precision, which may be cut off, and places of taps.
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    const double added = expected.pixels[i].b - picture.pixels[i].b;
                    EXPECT_NEAR(out.pixels[i].b, expected.pixels[i].b,
                                added * 5 * 0x1p-10 + 1e-5 + 3 * (0x1p-14 + 2 * gpu::test::filter_step()))
                        << width << "x" << height << ", " << i;
                    EXPECT_EQ(out.pixels[i].a, picture.pixels[i].a);
                }
            }
}

TEST(EffectAnamorphicStreaks, GpuLeavesDarkPicturesAlone) {
    const ReferenceImage picture = test::round_to_float(test::random_display(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 4, .threshold = 1}, picture), picture), 0);
    const ReferenceImage bright = lights(64, 48);
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, bright), bright), 0);
}

TEST(EffectAnamorphicStreaks, GpuNanAndInfinityStayContained) {
    const ReferenceImage out = developed({}, test::grey_with_no_numbers());
    test::expect_contained(out);
    // Beyond the lines beside those that they lie on nothing changes.
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            if (y < 8 || y > 24) {
                EXPECT_EQ(out.at(x, y).r, 0.5) << x << ", " << y;
            }
}

TEST(EffectAnamorphicStreaks, GpuLampsCountAlikeWhereverTheyLie) {
    test::expect_lamps_count_alike(
        [](Composer& composer) {
            composer.add(AnamorphicStreaks{.intensity = 1, .threshold = 0, .length = 40, .tint = {1, 1, 1}});
        },
        {1, 1, 1});
}

}  // namespace
}  // namespace darkroom
