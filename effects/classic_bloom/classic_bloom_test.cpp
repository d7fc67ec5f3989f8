// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/classic_bloom.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "classic_bloom/classic_bloom_reference.hpp"
#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

constexpr ClassicBloomSource hdr = ClassicBloomSource::Hdr, high_pass = ClassicBloomSource::HighPass,
                             layer = ClassicBloomSource::Layer;

Handle source_of(const ClassicBloom& bloom) { return bloom.source_kind == layer ? scene_alpha : scene_color; }

ReferenceImage developed(const ClassicBloom& bloom, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(bloom, {.source = source_of(bloom)}); }, picture,
                         {.kernels = kernels});
}

ReferenceImage reference(const ClassicBloom& bloom, const ReferenceImage& picture) {
    ReferenceImage source = picture;
    if (bloom.source_kind == layer)
        for (Rgba& color : source.pixels) color = {color.a, color.a, color.a, 1};
    return classic_bloom_reference(&bloom, {.picture = &picture, .source = &source});
}

/// Light up to 3, and any alpha.
ReferenceImage lights(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::round_to_float(test::random_display(width, height, 61));
    for (Rgba& color : picture.pixels) color = {3 * color.r, 3 * color.g, 3 * color.b, color.a};
    return test::round_to_float(picture);
}

/// The largest excess over what rounding can explain. Two writes in half precision, which the software driver cuts off
/// toward zero, up to 2^-10 of the value each; places of taps, floats, which across 256 pixels are known to 2^-15 of
/// one, and where they are filtered to filter_step in either direction, of light of up to 3; and the sum in single
/// precision.
double worst_excess(const ClassicBloom& bloom, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = reference(bloom, picture);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    const double place = 0x1p-15 + 2 * gpu::test::filter_step();
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &base = picture.pixels[i];
        const auto check = [&](double w, double g, double b) {
            const double allowed =
                std::abs(w - b) * 0x1p-9 + bloom.intensity * 3 * place + (std::abs(w) + std::abs(b)) * 1e-6;
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, base.r);
        check(want.g, got.g, base.g);
        check(want.b, got.b, base.b);
        if (got.a != static_cast<double>(static_cast<float>(base.a))) return 1e9;
    }
    return worst;
}

TEST(EffectClassicBloom, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{128u, 64u}, {131u, 67u}, {1u, 1u}, {9u, 2u}}) {
        const ReferenceImage picture = lights(width, height);
        for (const ClassicBloomSource kind : {hdr, high_pass, layer}) {
            // A tap between texels, fetched less precisely, may lie on the other side of the threshold.
            const bool is_between = width % 4 != 0 || height % 4 != 0;
            if (kind == high_pass && is_between && gpu::test::filter_step() != 0) continue;
            const ClassicBloom bloom{.intensity = 1, .source_kind = kind, .radius = 16};
            EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture)), 1.0) << width << "x" << height;
        }
    }
    const ReferenceImage picture = lights(96, 40);
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
        for (const std::int32_t radius : {8, 27, 64}) {
            const ClassicBloom bloom{.threshold = 0.5f, .radius = radius};
            EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture, kernels)), 1.0) << radius;
        }
}

TEST(EffectClassicBloom, EachSourceIsAnotherPicture) {
    // A lamp that alpha does not mark, and a dim sign that it does.
    ReferenceImage picture(192, 64, {0.1, 0.1, 0.1, 0});
    for (std::uint32_t y = 24; y < 40; ++y)
        for (std::uint32_t x = 24; x < 40; ++x) {
            picture.at(x, y) = {5, 5, 5, 0};
            picture.at(x + 120, y) = {0.5, 0.5, 0.5, 1};
        }
    const auto glow = [&](ClassicBloomSource kind) {
        const ClassicBloom bloom{.intensity = 1, .source_kind = kind, .radius = 16};
        const ReferenceImage out = developed(bloom, picture);
        if (out.pixels.size() != picture.pixels.size()) return std::pair{-1.0, -1.0};
        return std::pair{out.at(44, 32).r - 0.1, out.at(164, 32).r - 0.1};
    };
    const auto [lamp_hdr, sign_hdr] = glow(hdr);
    const auto [lamp_high_pass, sign_high_pass] = glow(high_pass);
    const auto [lamp_layer, sign_layer] = glow(layer);
    EXPECT_GT(lamp_hdr, 0.1);
    EXPECT_NEAR(sign_hdr, 0, 1e-6);
    // All of the light instead of what exceeds the threshold of 1: 5 for 4.
    EXPECT_NEAR(lamp_high_pass / lamp_hdr, 5.0 / 4.0, 0.01);
    EXPECT_NEAR(sign_high_pass, 0, 1e-6);
    EXPECT_NEAR(lamp_layer, 0, 1e-6);
    EXPECT_NEAR(sign_layer / lamp_hdr, 0.5 / 4.0, 0.01) << "the same shape, of light 0.5";
}

TEST(EffectClassicBloom, TheHighPassIsAStep) {
    const ClassicBloom bloom{.source_kind = high_pass, .threshold = 2};
    EXPECT_EQ(classic_bloom_reference_bright({1.99, 1.99, 1.99, 1}, bloom).r, 0);
    EXPECT_EQ(classic_bloom_reference_bright({2.01, 2.01, 2.01, 1}, bloom).r, 2.01);
    for (const double level : {1.99, 2.01}) {
        const ReferenceImage flat = test::uniform(64, 64, {level, level, level, 1});
        const ReferenceImage out = developed(bloom, flat);
        ASSERT_EQ(out.pixels.size(), flat.pixels.size());
        EXPECT_NEAR(out.at(31, 17).r, level > 2 ? 1.5 * level : level, level * 0x1p-9) << level;
    }
}

TEST(EffectClassicBloom, GoesFromSmallOverWideToFull) {
    Composer composer(Device::assumed());
    composer.add(ClassicBloom{}, {.source = scene_color});
    const ImageUse image{VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    const auto plan = composer.plan({.max_extent = {1920, 1080}, .color = image, .target = image});
    ASSERT_TRUE(plan) << plan.error().text;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;
    for (const PlanPass& pass : plan->passes) sizes.emplace_back(pass.extent.width, pass.extent.height);
    EXPECT_EQ(sizes, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{480, 270}, {960, 540}, {1920, 1080}}));
}

/// The glow `distance` away at an angle, bilinear.
double glow_at(const ReferenceImage& glow, double x, double y, double distance, double angle_rad) {
    return sample_reference(glow, (x + distance * std::cos(angle_rad)) / glow.width,
                            (y + distance * std::sin(angle_rad)) / glow.height)
        .r;
}

TEST(EffectClassicBloom, SpotsAreRoundAndNoStars) {
    ReferenceImage picture(160, 160);
    for (std::uint32_t y = 78; y < 82; ++y)
        for (std::uint32_t x = 78; x < 82; ++x) picture.at(x, y) = {101, 101, 101, 1};
    const ClassicBloom bloom{.intensity = 1, .radius = 30};
    ReferenceImage expected = reference(bloom, picture), gpu = developed(bloom, picture);
    ASSERT_EQ(gpu.pixels.size(), picture.pixels.size());
    for (ReferenceImage* const image : {&expected, &gpu}) {
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) image->pixels[i].r -= picture.pixels[i].r;
        const double peak = glow_at(*image, 80, 80, 0, 0);
        EXPECT_GT(peak, 1.0);
        for (const double distance : {8.0, 12.0, 16.0, 20.0, 26.0}) {
            double least = 1e9, most = 0;
            for (int i = 0; i < 64; ++i) {
                const double value = glow_at(*image, 80, 80, distance, 2 * std::numbers::pi * i / 64);
                least = std::min(least, value);
                most = std::max(most, value);
            }
            // A box has 100 % here at some distances, four crossed streaks nearly so.
            EXPECT_LE(most - least, 0.02 * peak) << distance;
        }
    }
}

TEST(EffectClassicBloom, EveryRadiusIsAnotherGlow) {
    const ClassicBloom glow;
    const EffectInfo& info = effect_info(glow);
    const auto row = std::ranges::find(info.parameters.rows, std::string_view("radius"), &ParamInfo::name);
    ASSERT_NE(row, info.parameters.rows.end());
    for (auto radius = static_cast<std::int32_t>(row->range.min); radius < row->range.max; ++radius)
        EXPECT_NE(classic_bloom_weights(radius), classic_bloom_weights(radius + 1)) << radius;
}

// Of a spot of 4x4 pixels, which are one of the small picture: its variance is the radius', along and across.
TEST(EffectClassicBloom, TheGlowIsAsWideAsItIsHigh) {
    ReferenceImage picture(192, 160);
    for (std::uint32_t y = 76; y < 80; ++y)
        for (std::uint32_t x = 92; x < 96; ++x) picture.at(x, y) = {101, 101, 101, 1};
    for (const std::int32_t radius : {12, 30, 48}) {
        const ClassicBloom bloom{.intensity = 1, .radius = radius};
        for (ReferenceImage glow : {reference(bloom, picture), developed(bloom, picture)}) {
            double sum = 0, across = 0, down = 0;
            for (std::uint32_t y = 0; y < glow.height; ++y)
                for (std::uint32_t x = 0; x < glow.width; ++x) {
                    const double light = glow.at(x, y).r - picture.at(x, y).r;
                    sum += light;
                    across += light * (x - 93.5) * (x - 93.5);
                    down += light * (y - 77.5) * (y - 77.5);
                }
            const double variance = radius * radius / 9.0;
            EXPECT_NEAR(across / sum, variance, 0.1 * variance) << radius;
            EXPECT_NEAR(down / sum, variance, 0.1 * variance) << radius;
        }
    }
}

TEST(EffectClassicBloom, FlatFieldsGlowByTheirLight) {
    const ReferenceImage flat = test::uniform(64, 48, {4, 3, 2, 1});
    const ClassicBloom bloom{.intensity = 0.5f, .source_kind = high_pass};
    const ReferenceImage out = test::reference_of(bloom, flat);
    EXPECT_NEAR(out.at(20, 20).r, 6, 1e-9);
    EXPECT_NEAR(out.at(20, 20).b, 3, 1e-9);
}

TEST(EffectClassicBloom, IntensityZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, picture), picture), 0.0);
}

TEST(EffectClassicBloom, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = lights(96, 96);
    const ClassicBloom kinds[] = {{.source_kind = hdr, .radius = 12},
                                  {.source_kind = high_pass, .radius = 12},
                                  {.source_kind = layer, .radius = 12}};
    for (const ClassicBloom& bloom : kinds) {
        ReferenceImage broken = picture;
        broken.at(48, 48) = {nan, infinity, -infinity, 1};
        broken.at(49, 48).a = nan;
        const ReferenceImage clean = developed(bloom, picture), out = developed(bloom, broken);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < 96; ++y)
            for (std::uint32_t x = 0; x < 96; ++x) {
                if (y == 48 && (x == 48 || x == 49)) continue;
                EXPECT_TRUE(std::isfinite(out.at(x, y).r) && std::isfinite(out.at(x, y).g)) << x << "," << y;
                if (std::max(std::abs(int(x) - 48), std::abs(int(y) - 48)) > 24) {
                    EXPECT_EQ(out.at(x, y).r, clean.at(x, y).r) << x << "," << y;
                }
            }
    }
}

}  // namespace
}  // namespace darkroom
