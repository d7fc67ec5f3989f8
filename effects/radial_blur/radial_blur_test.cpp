// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <darkroom/effects/radial_blur.hpp>

#include <darkroom/composer.hpp>

#include "compose/test_stacks/support.hpp"
#include "radial_blur/radial_blur_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectRadialBlur, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const float strength : {0.3f, 1.0f, 4.0f}) {
        SCOPED_TRACE(strength);
        // Where a tap falls between two pixels depends on uv in single precision: 1e-4 of a step between neighbours.
        const RadialBlur parameters{strength};
        const ReferenceImage expected = test::reference_of(parameters, picture);
        const ReferenceImage filtered = test::reference_of(parameters, test::filter_loss(picture));
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const auto fill = [&](Composer& composer) { composer.add(parameters); };
            const ReferenceImage out = test::develop(fill, picture, {.kernels = stage});
            EXPECT_LE(test::worst_difference(out, expected, filtered), 4e-4);
        }
    }
}

TEST(EffectRadialBlur, TheMiddleIsSharpAndCornersAreMeans) {
    ReferenceImage picture(64, 64);
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) picture.at(x, y) = {(x + y) % 2 == 0 ? 1.0 : 0.0, 0.5, 0, 1};
    const RadialBlur parameters{2.0f};
    const ReferenceImage out = test::reference_of(parameters, picture);
    EXPECT_EQ(out.at(32, 32).r, picture.at(32, 32).r);
    EXPECT_NEAR(out.at(2, 60).r, 0.5, 0.3);
    EXPECT_NEAR(out.at(2, 60).g, 0.5, 1e-12);
}

TEST(EffectRadialBlur, GpuMatchesReferenceOffCentre) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 2));
    // On the picture, at its edge, and outside of it.
    for (const Vec2 center : {Vec2{0.25f, 0.75f}, Vec2{1.0f, 0.0f}, Vec2{-0.5f, 0.5f}}) {
        SCOPED_TRACE(center.x);
        const RadialBlur parameters{1.5f, center};
        const ReferenceImage expected = test::reference_of(parameters, picture);
        const ReferenceImage filtered = test::reference_of(parameters, test::filter_loss(picture));
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const auto fill = [&](Composer& composer) { composer.add(parameters); };
            const ReferenceImage out = test::develop(fill, picture, {.kernels = stage});
            EXPECT_LE(test::worst_difference(out, expected, filtered), 4e-4);
        }
    }
}

// What god rays are composed of: a bright dot becomes a streak on the line through it and the centre, and nothing else.
TEST(EffectRadialBlur, ADotStreaksAlongTheLineThroughTheCentre) {
    const std::uint32_t size = 64;
    ReferenceImage picture(size, size);
    const std::uint32_t dot_x = 48, dot_y = 40;
    picture.at(dot_x, dot_y) = {100, 100, 100, 1};
    const Vec2 center{8.5f / size, 8.5f / size};
    const auto fill = [&](Composer& composer) { composer.add(RadialBlur{2.0f, center}); };
    const ReferenceImage out = test::develop(fill, picture);
    const double line_x = dot_x - 8.0, line_y = dot_y - 8.0, length = std::hypot(line_x, line_y);
    double farther = 0, nearer = 0;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const double along = ((x - 8.0) * line_x + (y - 8.0) * line_y) / length;
            const double off_line = std::abs((x - 8.0) * line_y - (y - 8.0) * line_x) / length;
            const double value = out.at(x, y).r;
            // Bilinear taps reach one pixel, which towards a corner is sqrt(2), and a streak widens with its distance.
            if (off_line > 2) {
                EXPECT_EQ(value, 0) << x << ' ' << y;
            }
            if (off_line <= 2 && along > length + 3) farther += value;
            if (off_line <= 2 && along < length - 3) nearer += value;
        }
    }
    EXPECT_GT(farther, 1);
    EXPECT_GT(nearer, 1);
}

TEST(EffectRadialBlur, TheCentreIsTheMiddleByDefault) {
    const RadialBlur parameters{1.0f};
    EXPECT_EQ(parameters.center.x, 0.5f);
    EXPECT_EQ(parameters.center.y, 0.5f);
    // A picture that is the same after a turn by 180 degrees stays so about its middle alone.
    ReferenceImage picture = test::random_display(32, 20, 3);
    for (std::uint32_t y = 0; y < 10; ++y)
        for (std::uint32_t x = 0; x < 32; ++x) picture.at(31 - x, 19 - y) = picture.at(x, y);
    const auto asymmetry = [&](const RadialBlur& blur) {
        const ReferenceImage out = test::reference_of(blur, picture);
        double worst = 0;
        for (std::uint32_t y = 0; y < 20; ++y)
            for (std::uint32_t x = 0; x < 32; ++x)
                worst = std::max(worst, std::abs(out.at(x, y).g - out.at(31 - x, 19 - y).g));
        return worst;
    };
    EXPECT_LE(asymmetry(parameters), 1e-12);
    EXPECT_GT(asymmetry({1.0f, {0.4f, 0.5f}}), 1e-3);
}

TEST(EffectRadialBlur, UpToAThousandthItIsOff) {
    const RadialBlur off{0.001f}, on{0.002f};
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

}  // namespace
}  // namespace darkroom
