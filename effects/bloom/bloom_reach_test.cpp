// SPDX-License-Identifier: MIT
// How far the glow reaches: the same part of the picture's height at every size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/bloom.hpp>
#include <numeric>
#include <vector>

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
    // Between two such heights the last level stands for a part of an octave, which it is wider than.
    const double part = std::log2(1440.0 / 1080), given = part * 0.45 * (1 - part) * (1 - part);
    expect(weights({2560, 1440}), {1 - part, 1, 1, 1, 1 + given, part - given});
    expect(weights({2560, 1440}, {.levels = 3}), {1 - part, 1, 1 + given, part - given});
    // A level that is finer than the glow hardly counts, but is not 0: the next one counts so much less.
    expect(weights({3840, 2160}), {0.125, 0.875, 1, 1, 1, 1});
    expect(weights({64, 4320}), {0.125, 0.125, 0.75});
    expect(weights({1920, 1080}, {.mode = BloomMode::EnergyConserving, .scatter = 0.5f}), {1, .5, .25, .125, .0625});
    expect(weights({960, 540}, {.mode = BloomMode::EnergyConserving, .scatter = 0.5f}), {1.5, .25, .125, .0625});
    expect(weights({960, 540}, published()), {1, 1, 1, 1, 1});
    expect(weights({3840, 2160}, published({.mode = BloomMode::EnergyConserving, .scatter = 0.5f})),
           {1, .5, .25, .125, .0625});
}

/// How much light lies within radii of `step` pixels more each, of `size` pixels a texel.
std::vector<double> light_within(const ReferenceImage& glow, double size, double step, std::size_t steps) {
    std::vector<double> out(steps);
    for (std::uint32_t y = 0; y < glow.height; ++y)
        for (std::uint32_t x = 0; x < glow.width; ++x) {
            const double radius = size * std::hypot(x + 0.5 - 0.5 * glow.width, y + 0.5 - 0.5 * glow.height);
            out[std::min(static_cast<std::size_t>(radius / step), steps - 1)] += glow.at(x, y).r;
        }
    std::partial_sum(out.begin(), out.end(), out.begin());
    return out;
}

constexpr double kernel_step = 0.05;
constexpr std::size_t kernel_steps = 1000;

/// What a level makes of a lamp of its own texel's size, brought up by a share of the tent: its light within radii.
std::vector<double> kernel_of(std::uint32_t level, double tent) {
    ReferenceImage lamp(256, 256);
    const std::uint32_t side = 2u << level, first = 128 - side / 2;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) lamp.at(first + x, first + y) = {1, 1, 1, 1};
    std::vector<ReferenceImage> down{bloom_reference_down(lamp)};
    while (down.size() <= level) down.push_back(bloom_reference_down(down.back()));
    ReferenceImage up = down.back();
    for (std::uint32_t above = level; above-- > 0;) {
        ReferenceImage onto(down[above].width, down[above].height);
        bloom_reference_add_up(onto, up, 1, above + 1 == level ? tent : 1);
        up = onto;
    }
    std::vector<double> out = light_within(up, 2, kernel_step, kernel_steps);
    const double all = out.back();
    for (double& light : out) light /= all;
    return out;
}

/// The part of the height within which 99 % of the glow's light lies.
double reach_of(const Bloom& bloom, std::uint32_t height) {
    constexpr std::uint32_t known = 2;  // wider levels are this one at twice the size each
    static const std::vector<std::vector<double>> whole{kernel_of(0, 1), kernel_of(1, 1), kernel_of(2, 1)};
    const BloomWeights weights = bloom_weights(bloom, {height, height});
    const std::vector<double> last =
        kernel_of(std::min(weights.count - 1, known), bloom_last_tent(bloom, {height, height}));
    const auto within = [&](std::uint32_t level, double radius) {
        const std::uint32_t like = std::min(level, known);
        const std::vector<double>& kernel = level + 1 == weights.count ? last : whole[like];
        const double at = std::ldexp(radius, static_cast<int>(like) - static_cast<int>(level)) / kernel_step - 1;
        const auto low = static_cast<std::size_t>(std::clamp(at, 0.0, kernel_steps - 2.0));
        return std::lerp(kernel[low], kernel[low + 1], std::clamp(at - static_cast<double>(low), 0.0, 1.0));
    };
    double near = 0, far = height;
    for (int i = 0; i < 40; ++i) {
        const double middle = (near + far) / 2;
        double light = 0;
        for (std::uint32_t level = 0; level < weights.count; ++level)
            light += weights.weights[level] * within(level, middle);
        (light < 0.99 * weights.total() ? near : far) = middle;
    }
    return near / height;
}

// By the pyramid's own filters.
TEST(EffectBloomReach, IsOnePartOfTheHeightAtEveryHeight) {
    const Bloom mixed{.mode = BloomMode::EnergyConserving};
    EXPECT_NEAR(reach_of({}, 1080), 0.09, 0.003);
    for (std::uint32_t height = 240; height <= 4320; height += height / 9) {
        EXPECT_NEAR(reach_of({}, height) / reach_of({}, 1080), 1, 0.03) << height;
        EXPECT_NEAR(reach_of(mixed, height) / reach_of(mixed, 1080), 1, 0.05) << height;
        EXPECT_NEAR(bloom_weights({}, {height, height}).total(), 5, 1e-9) << height;
    }
}

TEST(EffectBloomReach, ALineMoreChangesNoWeightByMuch) {
    const auto tent_of_last = [](std::uint32_t height) {
        const VkExtent2D extent{height, height};
        const BloomWeights weights = bloom_weights({}, extent);
        return weights.weights[weights.count - 1] * bloom_last_tent({}, extent);
    };
    for (std::uint32_t height = 240; height < 4320; ++height) {
        const BloomWeights one = bloom_weights({}, {height, height}),
                           next = bloom_weights({}, {height + 1, height + 1});
        // A weight of 1 comes or goes over an octave.
        for (std::size_t level = 0; level < BloomWeights::capacity; ++level)
            EXPECT_NEAR(one.weights[level], next.weights[level], 3.0 / height) << height << ": " << level;
        if (one.count == next.count) {
            EXPECT_NEAR(tent_of_last(height), tent_of_last(height + 1), 9.0 / height) << height;
        }
    }
}

// Of whole pictures, by the kernels that run.
TEST(EffectBloomReach, OneGlowAtEvenAndOddSizes) {
    const Bloom by_height{.intensity = 1, .firefly_filter = false};
    const auto reach = [](const Bloom& bloom, std::uint32_t height) {
        const ReferenceImage dark = lamp(height);
        ReferenceImage glow = with_glow(bloom, dark);
        for (std::size_t i = 0; i < dark.pixels.size(); ++i) glow.pixels[i].r -= dark.pixels[i].r;
        const std::vector<double> within = light_within(glow, 1, height / 2000.0, 2000);
        const auto found = std::lower_bound(within.begin(), within.end(), 0.99 * within.back());
        return static_cast<double>(found - within.begin()) / 2000;
    };
    const double known = reach(by_height, 1080);
    for (const std::uint32_t height : {240u, 360u, 405u, 541u, 720u, 767u})
        EXPECT_NEAR(reach(by_height, height) / known, 1, 0.03) << height;
    EXPECT_GT(reach(published(by_height), 360), 2 * reach(published(by_height), 1080));
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
