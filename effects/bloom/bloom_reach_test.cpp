// SPDX-License-Identifier: MIT
// How far the glow reaches: the same part of the picture's height at every size.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/bloom.hpp>

#include "bloom/bloom_reference.hpp"
#include "bloom/bloom_test_pictures.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

using test::published;

/// A lamp in the middle, 4 % of the height wide, before black.
ReferenceImage lamp(std::uint32_t height) {
    ReferenceImage out(height, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < height; ++x)
            if (std::hypot((x + 0.5) / height - 0.5, (y + 0.5) / height - 0.5) < 0.02) out.at(x, y) = {50, 50, 50, 1};
    return out;
}

ReferenceImage with_glow(const Bloom& bloom, const ReferenceImage& picture) {
    return test::develop([&](Composer& composer) { composer.add(bloom); }, picture);
}

/// Mean of the picture beside the lamp, at a distance in heights.
double glow_at(const ReferenceImage& picture, double distance) {
    double sum = 0;
    constexpr int directions = 64;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * 3.14159265358979 * i / directions;
        const double u = 0.5 + distance * std::cos(angle), v = 0.5 + distance * std::sin(angle);
        sum += bloom_reference_tap(picture, u, v).r / directions;
    }
    return sum;
}

TEST(EffectBloomReach, WeightsAreOctavesOfTheHeight) {
    const auto weights = [](VkExtent2D extent, const Bloom& bloom = {}) { return bloom_weights(bloom, extent); };
    const auto expect = [](const BloomWeights& got, std::initializer_list<double> want) {
        ASSERT_EQ(got.count, want.size());
        std::size_t i = 0;
        for (const double weight : want) EXPECT_NEAR(got.weights[i++], weight, 1e-9) << i;
    };
    expect(weights({1920, 1080}), {1, 1, 1, 1, 1});
    // What finer levels would add at a greater height, the first one does.
    expect(weights({960, 540}), {2, 1, 1, 1});
    const double part = std::log2(1440.0 / 1080);
    expect(weights({2560, 1440}), {1 - part, 1, 1, 1, 1, part});
    expect(weights({2560, 1440}, {.levels = 3}), {1 - part, 1, 1, part});
    // A level that is finer than the glow hardly counts, but is not 0.
    expect(weights({3840, 2160}), {0.125, 1, 1, 1, 1, 1});
    expect(weights({64, 4320}), {0.125, 0.125, 1});
    expect(weights({1920, 1080}, {.mode = BloomMode::EnergyConserving, .scatter = 0.5f}), {1, .5, .25, .125, .0625});
    expect(weights({960, 540}, {.mode = BloomMode::EnergyConserving, .scatter = 0.5f}), {1.5, .25, .125, .0625});
    expect(weights({960, 540}, published()), {1, 1, 1, 1, 1});
    expect(weights({3840, 2160}, published({.mode = BloomMode::EnergyConserving, .scatter = 0.5f})),
           {1, .5, .25, .125, .0625});
    for (const std::uint32_t height : {200u, 360u, 1081u, 1600u, 2100u})
        EXPECT_NEAR(weights({4000, height}).total(), 5, 0.13) << height;
}

// By pixels the glow of a large picture is a tenth of that of a small one.
TEST(EffectBloomReach, OneGlowAt360And1440Lines) {
    const Bloom by_height{.intensity = 1, .firefly_filter = false};
    const auto ratio = [](const Bloom& bloom, double distance) {
        return glow_at(with_glow(bloom, lamp(1440)), distance) / glow_at(with_glow(bloom, lamp(360)), distance);
    };
    for (const double distance : {0.03, 0.04, 0.06, 0.08}) EXPECT_NEAR(ratio(by_height, distance), 1, 0.2) << distance;
    for (const double distance : {0.06, 0.08}) EXPECT_LT(ratio(published(by_height), distance), 0.5) << distance;
}

// Under dynamic resolution the glow does not breathe: from one height to the next nothing jumps, past that at which a
// level more begins, too.
TEST(EffectBloomReach, GrowsSmoothlyWithTheHeight) {
    const Bloom bloom{.intensity = 1, .firefly_filter = false};
    const auto glow = [&](std::uint32_t height) { return glow_at(with_glow(bloom, lamp(height)), 0.05); };
    double before = glow(500);
    for (const std::uint32_t height : {520u, 540u, 544u, 560u, 580u}) {
        const double now = glow(height);
        EXPECT_NEAR(now / before, 1, 0.05) << height;
        before = now;
    }
}

}  // namespace
}  // namespace darkroom
