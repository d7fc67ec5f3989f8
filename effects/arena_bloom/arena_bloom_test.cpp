// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/arena_bloom.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "arena_bloom/arena_bloom_reference.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

constexpr ArenaBloomSource masked = ArenaBloomSource::Masked, plain = ArenaBloomSource::Plain;

ReferenceImage developed(const ArenaBloom& bloom, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(bloom); }, picture, {.kernels = kernels});
}

TEST(EffectArenaBloom, GlowsAboveHalfOfTheCutOff) {
    constexpr std::array<std::pair<double, double>, 5> table{
        {{0.25, 0}, {0.4625, 0}, {0.5, 0.225}, {0.75, 1.725}, {1, 3.225}}};
    for (const auto& [grey, glow] : table) {
        EXPECT_NEAR(arena_bloom_reference_bright({grey, grey, grey, 1}, masked).r, glow, 1e-12) << grey;
        EXPECT_NEAR(arena_bloom_reference_bright({grey, grey, grey, 1}, plain).r, glow, 1e-12) << grey;
    }
    // Hue is kept; what lies above 1 counts as 1, and alpha is a share, in one kind and not in the other.
    EXPECT_NEAR(arena_bloom_reference_bright({1, 0.5, 0, 1}, masked).g, 0.5 * 3.225, 1e-12);
    EXPECT_NEAR(arena_bloom_reference_bright({4, 4, 4, 1}, masked).r, 3.225, 1e-12);
    EXPECT_NEAR(arena_bloom_reference_bright({4, 4, 4, 1}, plain).r, (4 - 0.4625) * 6, 1e-12);
    EXPECT_NEAR(arena_bloom_reference_bright({1, 1, 1, 0.5}, masked).r, 0.5 * 3.225, 1e-12);
    EXPECT_NEAR(arena_bloom_reference_bright({1, 1, 1, 0}, masked).r, 0, 1e-12);
    EXPECT_NEAR(arena_bloom_reference_bright({1, 1, 1, 0}, plain).r, 3.225, 1e-12);
}

TEST(EffectArenaBloom, PicturesHaveThePublishedSizes) {
    Composer composer(Device::assumed());
    composer.add(ArenaBloom{}, {.source = scene_color});
    const ImageUse image{VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    const auto plan = composer.plan({.max_extent = {1920, 1080}, .color = image, .target = image});
    ASSERT_TRUE(plan) << plan.error().text;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;
    for (const PlanPass& pass : plan->passes) sizes.emplace_back(pass.extent.width, pass.extent.height);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> expected{
        {480, 270}, {240, 135}, {120, 67}, {60, 33}, {30, 16}, {480, 270}, {960, 540}, {1920, 1080}};
    EXPECT_EQ(sizes, expected);
}

/// The flat field's glow: all four levels hold the bright part.
double glow_of_flat(double bright) { return std::pow(std::min(0.87 * bright, 1.0), 2.2); }

TEST(EffectArenaBloom, FlatFieldsHaveTheWeightsAndThePower) {
    for (const double grey : {0.4, 0.5, 0.6, 0.75, 1.0}) {
        const ReferenceImage flat = test::uniform(256, 128, {grey, grey, grey, 1});
        const double glow = glow_of_flat(arena_bloom_reference_bright({grey, grey, grey, 1}, masked).r);
        EXPECT_NEAR(test::reference_of(ArenaBloom{}, flat).at(77, 50).r, grey + glow, 1e-12) << grey;
        const ReferenceImage out = developed({}, flat);
        ASSERT_EQ(out.pixels.size(), flat.pixels.size());
        // Six writes in half precision before the power, two behind it; and its own error.
        EXPECT_NEAR(out.at(77, 50).r, grey + glow, glow * (6 * 2.2 + 2) * 0x1p-10 + 1e-5) << grey;
    }
}

/// The largest excess over what rounding can explain: up to six writes in half precision, which the software driver
/// cuts off toward zero, 2^-10 of the value each, lie before the power 2.2, two behind it. Values of the glow are at
/// most 1.
double worst_excess(const ArenaBloom& bloom, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = test::reference_of(bloom, picture);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &base = picture.pixels[i];
        const auto check = [&](double w, double g, double b) {
            const double glow = std::abs(w - b);
            const double allowed =
                glow * (6 * 2.2 + 2) * 0x1p-10 + bloom.intensity * 4e-5 + (std::abs(w) + std::abs(b)) * 2e-6;
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, base.r);
        check(want.g, got.g, base.g);
        check(want.b, got.b, base.b);
        if (got.a != static_cast<double>(static_cast<float>(base.a))) return 1e9;
    }
    return worst;
}

TEST(EffectArenaBloom, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{256u, 128u}, {131u, 97u}, {1u, 1u}, {7u, 3u}}) {
        const ReferenceImage display = test::round_to_float(test::random_display(width, height, 51));
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(worst_excess({}, display, developed({}, display, kernels)), 1.0) << width << "x" << height;
        const ReferenceImage hdr = test::round_to_float(test::random_hdr(width, height, 52));
        for (const ArenaBloomSource kind : {masked, plain})
            EXPECT_LE(worst_excess({2.0f, kind}, hdr, developed({2.0f, kind}, hdr)), 1.0) << width << "x" << height;
    }
}

// At twice the height each weight is that of the next level, in between two levels share it, and at no height is any
// lost.
TEST(EffectArenaBloom, WeightsMoveWithTheHeight) {
    const auto expect = [](std::uint32_t height, const std::array<double, arena_bloom_max_levels>& weights) {
        const auto got = arena_bloom_weights(height);
        for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(got[i], weights[i], 1e-9) << height << ", " << i;
    };
    expect(1080, {0.32, 0.10, 0.20, 0.25, 0, 0});
    expect(2160, {0, 0.32, 0.10, 0.20, 0.25, 0});
    expect(540, {0.42, 0.20, 0.25, 0, 0, 0});
    const double part = std::log2(1440 / 1080.0);
    expect(1440, {0.32 * (1 - part), 0.32 * part + 0.10 * (1 - part), 0.10 * part + 0.20 * (1 - part),
                  0.20 * part + 0.25 * (1 - part), 0.25 * part, 0});
    for (const std::uint32_t height : {1u, 200u, 777u, 1500u, 4320u, 16384u}) {
        const auto weights = arena_bloom_weights(height);
        EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 0.87, 1e-9) << height;
    }
    for (const std::uint32_t height : {97u, 1300u}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(64, height, 51));
        const ArenaBloom bloom{.reach = Reach::Height};
        EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture)), 1.0) << height;
    }
}

TEST(EffectArenaBloom, IntensityZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, picture), picture), 0.0);
}

TEST(EffectArenaBloom, OnlyWhatAlphaShowsGlows) {
    ReferenceImage picture(256, 128, {0, 0, 0, 0});
    for (std::uint32_t y = 56; y < 72; ++y)
        for (std::uint32_t x = 56; x < 72; ++x) {
            picture.at(x, y) = {1, 1, 1, 1};
            picture.at(x + 128, y) = {1, 1, 1, 0};
        }
    const ReferenceImage out = developed({}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    EXPECT_GT(out.at(50, 64).r, 0.02);
    EXPECT_NEAR(out.at(50 + 128, 64).r, 0, 1e-3);
    const ReferenceImage all = developed({.source_kind = plain}, picture);
    ASSERT_EQ(all.pixels.size(), picture.pixels.size());
    EXPECT_GT(all.at(50 + 128, 64).r, 0.02);
}

TEST(EffectArenaBloom, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(128, 128, 9));
    picture.at(60, 60) = {nan, infinity, -infinity, nan};
    for (const ArenaBloomSource kind : {masked, plain}) {
        const ReferenceImage out = developed({1.0f, kind}, picture);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < 128; ++y)
            for (std::uint32_t x = 0; x < 128; ++x)
                if (x != 60 || y != 60) {
                    EXPECT_TRUE(std::isfinite(out.at(x, y).r) && std::isfinite(out.at(x, y).g)) << x << "," << y;
                }
    }
}

}  // namespace
}  // namespace darkroom
