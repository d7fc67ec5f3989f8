// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/effects/god_rays.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "god_rays/god_rays_reference.hpp"

namespace darkroom {
namespace {

constexpr std::uint32_t width = 160, height = 96;
constexpr double sky = 1e10;

ReferenceImage developed(const GodRays& rays, const ReferenceImage& picture, const test::RunOptions& options = {}) {
    return test::develop([&](Composer& composer) { composer.add(rays); }, picture, options);
}

/// A dim sky with a bright disc around a place of the picture.
ReferenceImage disc(double u, double v, double radius = 0.08) {
    ReferenceImage out(width, height, {0.1, 0.1, 0.1, 0.5});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double dx = (x + 0.5 - u * width) / height, dy = (y + 0.5 - v * height) / height;
            if (std::hypot(dx, dy) < radius) out.at(x, y) = {30, 20, 10, 0.5};
        }
    return test::round_to_float(out);
}

TEST(EffectGodRays, TheLightsPlaceIsItsDirectionThroughTheCamera) {
    const Camera camera = test::look_at({3, 5, 9}, {3, 5, 0}, 1.0, 16.0 / 9);
    const auto place = [&](const std::array<float, 3>& direction) {
        const Light light{.direction = direction};
        return god_rays_light({}, &camera, &light);
    };
    EXPECT_NEAR(place({0, 0, -1}).u, 0.5, 1e-6);
    EXPECT_NEAR(place({0, 0, -1}).v, 0.5, 1e-6);
    EXPECT_EQ(place({0, 0, -1}).fade, 1);
    // Half the field of view upward is the upper edge.
    const float slope = std::tan(0.5f);
    EXPECT_NEAR(place({0, slope, -1}).v, 0, 1e-6);
    EXPECT_NEAR(place({0, slope * 1.5f, -1}).fade, 0.5, 1e-5);
    EXPECT_EQ(place({0, slope * 2.1f, -1}).fade, 0);
    EXPECT_EQ(place({0, 0, 1}).fade, 0) << "behind the camera";
    EXPECT_EQ(place({1, 0, 0}).fade, 0);
    const GodRays fixed{.follows_light = false, .position = {0.2f, 0.7f}};
    const Light light{.direction = {0, 0, 1}};
    EXPECT_EQ(god_rays_light(fixed, &camera, &light).u, double{0.2f});
    EXPECT_EQ(god_rays_light(fixed, &camera, &light).fade, 1);
    EXPECT_EQ(god_rays_light({.position = {0.2f, 0.7f}}, &camera, nullptr).v, double{0.7f});
}

TEST(EffectGodRays, GpuStreaksRunAwayFromTheLight) {
    const ReferenceImage picture = disc(0.5, 0.5);
    // The light beside the bright disc: streaks of it run to the right, away from the light, and nowhere else.
    const GodRays rays{.intensity = 1, .position = {0.3f, 0.5f}, .radius = 4, .decay = 1};
    const ReferenceImage out = developed(rays, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    const auto added = [&](std::uint32_t x, std::uint32_t y) { return out.at(x, y).r - picture.at(x, y).r; };
    double before = 1e9;
    for (std::uint32_t x = 96; x < width; x += 4) {
        EXPECT_GT(added(x, 48), 0.05) << x;
        EXPECT_LT(added(x, 48), before) << x;
        before = added(x, 48);
    }
    EXPECT_EQ(added(20, 48), 0) << "beyond the light";
    EXPECT_EQ(added(80, 4), 0) << "to the side";
    EXPECT_EQ(out.at(120, 48).a, 0.5);
    // Its colour is that of the disc: light above the threshold keeps its ratios.
    EXPECT_NEAR((out.at(120, 48).b - 0.1) / added(120, 48), 1.0 / 3, 0.01);
}

TEST(EffectGodRays, GpuAnOccluderCastsADarkStreak) {
    const ReferenceImage picture = disc(0.5, 0.5, 0.3);
    ReferenceImage depth(width, height, {sky, 0, 0, 1});
    // A post to the right of the light, inside the disc.
    for (std::uint32_t y = 44; y < 52; ++y)
        for (std::uint32_t x = 92; x < 108; ++x) depth.at(x, y).r = 7;
    const GodRays rays{.intensity = 1, .position = {0.5f, 0.5f}, .radius = 2, .density = 0.8f, .decay = 1};
    const ReferenceImage out = developed(rays, picture, {.depth = &depth});
    const ReferenceImage open = developed(rays, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    // Behind the post, and at the same distance on the other side.
    EXPECT_LT(out.at(140, 48).r, 0.75 * out.at(19, 48).r);
    EXPECT_NEAR(out.at(19, 48).r / open.at(19, 48).r, 1, 0.01);
    // With everything near there is nothing left.
    depth = ReferenceImage(width, height, {7, 0, 0, 1});
    EXPECT_EQ(test::worst_difference(developed(rays, picture, {.depth = &depth}), picture), 0);
}

TEST(EffectGodRays, GpuFadesAsTheLightLeaves) {
    const ReferenceImage picture = disc(0.5, 0.06, 0.05);
    const Camera camera = test::look_at({0, 0, 0}, {0, 0, -1}, 1.0, 160.0 / 96);
    const auto at_slope = [&](double slope) {
        const std::vector<ReferenceLight> lights{{.light = {.direction = {0, static_cast<float>(slope), -1}}}};
        return developed({.intensity = 2, .radius = 4}, picture, {.camera = camera, .lights = lights});
    };
    const double edge = std::tan(0.5);
    const double on_screen = at_slope(edge * 0.95).at(80, 40).r, outside = at_slope(edge * 1.6).at(80, 40).r;
    EXPECT_GT(on_screen, 0.11);
    EXPECT_LT(outside, on_screen);
    EXPECT_GT(outside, 0.1);
    EXPECT_EQ(test::worst_difference(at_slope(edge * 2.01), picture), 0);
    const std::vector<ReferenceLight> behind{{.light = {.direction = {0, 0, 1}}}};
    EXPECT_EQ(
        test::worst_difference(developed({.intensity = 2}, picture, {.camera = camera, .lights = behind}), picture), 0);
}

TEST(EffectGodRays, OffAtZero) {
    const GodRays off{.intensity = 0}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    EXPECT_EQ(test::worst_difference(developed(off, picture), picture), 0);
}

TEST(EffectGodRays, BrightnessDoesNotDependOnTheNumberOfSamples) {
    const ReferenceImage picture = disc(0.5, 0.5, 0.25);
    const auto at = [&](std::int32_t samples) {
        return test::reference_of(GodRays{.position = {0.5f, 0.5f}, .samples = samples}, picture).at(130, 48).r - 0.1;
    };
    EXPECT_GT(at(256), 0.05);
    EXPECT_NEAR(at(64) / at(256), 1, 0.03);
}

TEST(EffectGodRays, GpuMatchesReference) {
    ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 3)), depth(67, 41, {sky, 0, 0, 1});
    for (std::uint32_t i = 0; i < depth.pixels.size(); ++i) {
        if (i % 7 == 3) depth.pixels[i].r = i;
        if (i % 11 == 2) picture.pixels[i] = {20, 9, 4, 1};
    }
    const Camera camera = test::look_at({0, 1, 2}, {2, 2, -9}, 1.1, 67.0 / 41);
    const std::vector<ReferenceLight> lights{{.light = {.direction = {0.4f, 0.3f, -1}}}};
    for (const GodRays& rays :
         {GodRays{}, GodRays{.intensity = 3, .threshold = 0.2f, .ceiling = 2, .samples = 13, .tint = {1, 0.5f, 0.1f}},
          GodRays{.intensity = 20,
          .follows_light = false,
          .position = {1.2f, -0.2f},
          .radius = 2,
          .density = 1,
          .decay = 0.9f,
          .samples = 100},
          GodRays{.follows_light = false, .radius = 0.2f, .samples = 1}}) {
        const test::RunOptions options{.depth = &depth, .camera = camera, .lights = lights};
        const ReferenceImage expected = test::scene_reference_of(rays, picture, options);
        double most = 0;
        for (std::size_t i = 0; i < expected.pixels.size(); ++i)
            most = std::max(most, expected.pixels[i].r - picture.pixels[i].r);
        EXPECT_GT(most, 0.01) << rays.samples;
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            test::RunOptions run = options;
            run.kernels = stage;
            // Two writes in half precision, cut off by up to 2^-10 each, and taps placed by single precision.
            EXPECT_LE(test::worst_difference(developed(rays, picture, run), expected), most * 0.003) << rays.samples;
        }
    }
}

TEST(EffectGodRays, GpuHostileValuesAreHarmless) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 2u}, {9u, 5u}, {33u, 18u}}) {
        ReferenceImage picture(w, h, {0.5, 0.5, 0.5, 1}), depth(w, h, {sky, 0, 0, 1}), clean = picture;
        clean.at(0, 0) = picture.at(0, 0) = {1e4, 1e4, 1e4, 1};
        if (w > 3) {
            picture.at(4, 3) = {nan, infinity, -infinity, 1};
            depth.at(5, 2).r = nan;
        }
        for (const GodRays& rays :
             {GodRays{.intensity = 64, .threshold = 0, .ceiling = 65504, .samples = 256, .tint = {64, 64, 64}},
              GodRays{.density = 0, .samples = 1}, GodRays{.position = {0, 0}, .radius = 0.01f, .decay = 0.001f}}) {
            const ReferenceImage out = developed(rays, picture, {.depth = &depth});
            for (std::uint32_t i = 0; i < out.pixels.size(); ++i) {
                if (w > 3 && i == 3 * w + 4) continue;
                ASSERT_TRUE(std::isfinite(out.pixels[i].r)) << w << "x" << h << " " << i;
                ASSERT_GE(out.pixels[i].r, clean.pixels[i].r);
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
