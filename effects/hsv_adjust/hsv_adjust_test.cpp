// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/hsv_adjust.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "hsv_adjust/hsv_adjust_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array<HsvAdjust, 6> settings{{{.hue = 77},
                                             {.hue = -180},
                                             {.saturation = 0},
                                             {.saturation = 3},
                                             {.value = 0.3f},
                                             {.hue = -20, .saturation = 1.5f, .value = 2}}};

Rgba adjusted(Rgba color, const HsvAdjust& hsv) { return hsv_adjust_reference(color, {}, hsv); }

void expect_color(const Rgba& got, double r, double g, double b) {
    EXPECT_NEAR(got.r, r, 1e-7);
    EXPECT_NEAR(got.g, g, 1e-7);
    EXPECT_NEAR(got.b, b, 1e-7);
}

TEST(EffectHsvAdjust, PrimariesHaveTheirPublishedPlaces) {
    const std::array<std::array<double, 3>, 6> around{
        {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}}};
    for (std::size_t i = 0; i < around.size(); ++i) {
        const auto [r, g, b] = around[i];
        const Hsv hsv = hsv_of(r, g, b);
        EXPECT_DOUBLE_EQ(hsv.hue, static_cast<double>(i));
        EXPECT_DOUBLE_EQ(hsv.saturation, 1.0);
        EXPECT_DOUBLE_EQ(hsv.value, 1.0);
    }
    EXPECT_DOUBLE_EQ(hsv_of(0.8, 0.4, 0.4).saturation, 0.5);
}

TEST(EffectHsvAdjust, TurnsTheHueAlone) {
    expect_color(adjusted({1, 0, 0, 1}, {.hue = 120}), 0, 1, 0);
    expect_color(adjusted({1, 0, 0, 1}, {.hue = -120}), 0, 0, 1);
    expect_color(adjusted({0.2, 0.6, 0.4, 1}, {.hue = 180}), 0.6, 0.2, 0.4);
    // There and back.
    const Rgba color{0.7, 0.2, 3.0, 0.4}, there = adjusted(color, {.hue = 100}), back = adjusted(there, {.hue = -100});
    expect_color(back, color.r, color.g, color.b);
    EXPECT_EQ(back.a, 0.4);
}

TEST(EffectHsvAdjust, SaturationKeepsValueAndGrey) {
    expect_color(adjusted({0.8, 0.4, 0.6, 1}, {.saturation = 0}), 0.8, 0.8, 0.8);
    expect_color(adjusted({0.8, 0.4, 0.6, 1}, {.saturation = 1.5f}), 0.8, 0.2, 0.5);
    expect_color(adjusted({0.8, 0.4, 0.6, 1}, {.saturation = 8}), 0.8, 0.0, 0.4);
    for (const HsvAdjust& hsv : settings) {
        const Rgba grey = adjusted({0.3, 0.3, 0.3, 1}, hsv);
        expect_color(grey, 0.3 * double{hsv.value}, 0.3 * double{hsv.value}, 0.3 * double{hsv.value});
    }
}

TEST(EffectHsvAdjust, ValueScalesAllChannels) {
    expect_color(adjusted({0.8, 0.4, 6, 1}, {.value = 0.5f}), 0.4, 0.2, 3);
    expect_color(adjusted({-1, 0.4, 6, 1}, {.value = 2}), 0, 0.8, 12);
}

TEST(EffectHsvAdjust, GpuNeutralChangesNothing) {
    const HsvAdjust neutral;
    EXPECT_TRUE(effect_info(neutral).is_identity(&neutral));
    for (const HsvAdjust& hsv : settings) EXPECT_FALSE(effect_info(hsv).is_identity(&hsv));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(neutral); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

// The model measures from the largest channel, so that is what single precision is a part of: 16 roundings of 2^-24.
TEST(EffectHsvAdjust, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{67u, 41u}, {1u, 1u}, {1u, 7u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(width, height, 1));
        for (const HsvAdjust& hsv : settings)
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage expected = test::reference_of(hsv, picture);
                const ReferenceImage out =
                    test::develop([&](Composer& composer) { composer.add(hsv); }, picture, {.kernels = stage});
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    const Rgba &got = out.pixels[i], &want = expected.pixels[i];
                    const double allowed = 0x1p-20 * std::max({want.r, want.g, want.b});
                    EXPECT_LE(std::abs(got.r - want.r), allowed) << i << " " << hsv.hue;
                    EXPECT_LE(std::abs(got.g - want.g), allowed) << i << " " << hsv.hue;
                    EXPECT_LE(std::abs(got.b - want.b), allowed) << i << " " << hsv.hue;
                    EXPECT_EQ(got.a, want.a);
                }
            }
    }
}

TEST(EffectHsvAdjust, GpuNanIsBlackAndInfinityFinite) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture(2, 1, {nan, nan, nan, 1});
    picture.at(1, 0) = {infinity, 1, -infinity, 1};
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(HsvAdjust{.hue = 10, .saturation = 2}); }, picture);
    EXPECT_EQ(out.at(0, 0).r + out.at(0, 0).g + out.at(0, 0).b, 0.0);
    EXPECT_TRUE(std::isfinite(out.at(1, 0).r) && std::isfinite(out.at(1, 0).g) && std::isfinite(out.at(1, 0).b));
}

}  // namespace
}  // namespace darkroom
