// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/blend.hpp>
#include <darkroom/effects/negative.hpp>

#include <algorithm>
#include <array>

#include "blend/blend_reference.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

constexpr std::array all_modes{BlendMode::Mix,        BlendMode::Add,     BlendMode::Screen,
                               BlendMode::Multiply,   BlendMode::Lighten, BlendMode::Darken,
                               BlendMode::Difference, BlendMode::Overlay, BlendMode::SoftLight};
constexpr std::array samples{0.0, 0.1, 0.5, 0.75, 1.0, 3.0, 100.0};

TEST(EffectBlend, ModesHaveTheirValues) {
    const auto value = [](BlendMode mode) { return blend_reference(0.25, 0.5, mode); };
    EXPECT_DOUBLE_EQ(value(BlendMode::Mix), 0.5);
    EXPECT_DOUBLE_EQ(value(BlendMode::Add), 0.75);
    EXPECT_DOUBLE_EQ(value(BlendMode::Screen), 1.0 - 0.75 * 0.5);
    EXPECT_DOUBLE_EQ(value(BlendMode::Multiply), 0.125);
    EXPECT_DOUBLE_EQ(value(BlendMode::Lighten), 0.5);
    EXPECT_DOUBLE_EQ(value(BlendMode::Darken), 0.25);
    EXPECT_DOUBLE_EQ(value(BlendMode::Difference), 0.25);
    EXPECT_DOUBLE_EQ(value(BlendMode::Overlay), 0.25);
    EXPECT_DOUBLE_EQ(value(BlendMode::SoftLight), 0.25);
    EXPECT_DOUBLE_EQ(blend_reference(0.75, 0.2, BlendMode::Overlay), 1.0 - 2.0 * 0.25 * 0.8);
    EXPECT_DOUBLE_EQ(blend_reference(0.6, 0.0, BlendMode::SoftLight), 0.36);
    EXPECT_DOUBLE_EQ(blend_reference(0.6, 1.0, BlendMode::SoftLight), 2.0 * 0.6 - 0.36);
}

// Each mode has a layer that changes nothing, for light above 1 too.
TEST(EffectBlend, NeutralLayersChangeNothing) {
    for (const double base : samples) {
        EXPECT_DOUBLE_EQ(blend_reference(base, 0.0, BlendMode::Add), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 0.0, BlendMode::Screen), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 1.0, BlendMode::Multiply), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 0.0, BlendMode::Lighten), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 1e9, BlendMode::Darken), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 0.0, BlendMode::Difference), base);
        EXPECT_DOUBLE_EQ(blend_reference(base, 0.5, BlendMode::SoftLight), base);
    }
    EXPECT_DOUBLE_EQ(blend_reference(0.3, 0.5, BlendMode::Overlay), 0.3);
}

TEST(EffectBlend, MoreLightNeverGivesLess) {
    for (const BlendMode mode : {BlendMode::Mix, BlendMode::Add, BlendMode::Screen, BlendMode::Multiply,
                                 BlendMode::Lighten, BlendMode::Darken, BlendMode::Overlay, BlendMode::SoftLight}) {
        for (const double fixed : samples) {
            for (std::size_t i = 1; i < samples.size(); ++i) {
                EXPECT_GE(blend_reference(samples[i], fixed, mode) + 1e-12,
                          blend_reference(samples[i - 1], fixed, mode))
                    << static_cast<int>(mode) << " base " << samples[i] << " layer " << fixed;
                EXPECT_GE(blend_reference(fixed, samples[i], mode) + 1e-12,
                          blend_reference(fixed, samples[i - 1], mode))
                    << static_cast<int>(mode) << " base " << fixed << " layer " << samples[i];
            }
        }
    }
}

TEST(EffectBlend, ScreenIsSymmetricAndAtLeastTheBrighter) {
    for (const double a : samples) {
        for (const double b : samples) {
            EXPECT_DOUBLE_EQ(blend_reference(a, b, BlendMode::Screen), blend_reference(b, a, BlendMode::Screen));
            EXPECT_GE(blend_reference(a, b, BlendMode::Screen) + 1e-12, std::max(a, b));
        }
    }
}

TEST(EffectBlend, AlphaIsThePictures) {
    const ReferenceImage base = test::uniform(2, 2, {0.1, 0.2, 0.3, 0.4});
    const ReferenceImage layer = test::uniform(2, 2, {0.9, 0.8, 0.7, 1.0});
    const ReferenceImage out = test::reference_of(Blend{.amount = 1.0f}, base, &layer);
    EXPECT_EQ(out.at(1, 1).a, 0.4);
    EXPECT_EQ(out.at(1, 1).r, 0.9);
}

/// The scene under its own negative.
ReferenceImage developed(const Blend& parameters, const ReferenceImage& picture) {
    return test::develop(
        [&](Composer& composer) {
            const Handle layer = composer.add(Negative{});
            composer.add(parameters, {.input = scene_color, .second = layer});
        },
        picture);
}

TEST(EffectBlend, GpuLeavesThePictureAtZero) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    EXPECT_EQ(test::worst_difference(developed({.mode = BlendMode::Add, .amount = 0.0f}, picture), picture), 0.0);
}

TEST(EffectBlend, GpuMatchesReference) {
    for (const ReferenceImage& picture :
         {test::round_to_float(test::random_hdr(67, 41, 1)), test::round_to_float(test::random_display(48, 48, 2))}) {
        const ReferenceImage layer = test::round_to_float(test::reference_of(Negative{}, picture));
        for (const BlendMode mode : all_modes) {
            for (const float amount : {0.25f, 1.0f}) {
                const Blend parameters{.mode = mode, .amount = amount};
                EXPECT_LE(test::worst_half_ulps(developed(parameters, picture),
                                                test::reference_of(parameters, picture, &layer)),
                          2.0)
                    << static_cast<int>(mode) << " amount " << amount;
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
