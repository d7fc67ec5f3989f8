// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/fog.hpp>

#include <array>
#include <darkroom/composer.hpp>

#include "compose/test_stacks/support.hpp"
#include "fog/fog_reference.hpp"

namespace darkroom {
namespace {

/// A picture whose pixels lie at many distances: a few metres to the left, beyond the end and in the sky to the right.
struct Case {
    ReferenceImage picture = test::round_to_float(test::random_display(37, 23, 3));
    ReferenceImage depth{37, 23};
    Camera camera = test::look_at({1, 3, 2}, {4, 1, -9}, 1.1, 37.0 / 23);

    Case() {
        for (std::uint32_t y = 0; y < 23; ++y)
            for (std::uint32_t x = 0; x < 37; ++x) {
                const double distance = x > 33 ? 1e10 : std::exp2(x * 0.25) + y * 0.1;
                depth.at(x, y).r = double{static_cast<float>(distance)};
            }
    }
    [[nodiscard]] test::RunOptions options() const { return {.depth = &depth, .camera = camera}; }
};

TEST(EffectFog, HasTheDocumentedValues) {
    const Fog fog{.density = 0.02f, .start = 5, .end = 100};
    EXPECT_EQ(fog_amount(5, fog), 0);
    EXPECT_NEAR(fog_amount(10, fog), 0.1119, 5e-5);
    EXPECT_NEAR(fog_amount(50, fog), 0.6978, 5e-5);
    EXPECT_EQ(fog_amount(100, fog), 1);
    EXPECT_EQ(fog_amount(1000, fog), 1);
}

TEST(EffectFog, WithoutAnEndItIsTheExponential) {
    const Fog fog{.density = 0.02f, .start = 5, .end = 1e9f};
    for (const auto& [distance, amount] :
         {std::pair{5.0, 0.0}, {10.0, .0952}, {50.0, .5934}, {100.0, .8504}, {200.0, .9798}})
        EXPECT_NEAR(fog_amount(distance, fog), amount, 5e-5) << distance;
}

TEST(EffectFog, TheEndPointThinsAboveTheOriginAndNotBelow) {
    const Fog fog{
        .height_enabled = true, .height_form = FogHeight::EndPoint, .height_falloff = 0.5f, .height_origin = 1};
    EXPECT_EQ(fog_amount(40, -7, fog, 0), fog_amount(40, 1, fog, 0));
    EXPECT_NEAR(fog_amount(40, 3, fog, 0), fog_amount(40, 1, fog, 0) * std::exp(-1.0), 1e-12);
}

// Light comes through the fog of the whole way, slice by slice: up out of it, down into it, level, and through the
// height at which it begins to thin.
TEST(EffectFog, TheIntegralIsASumOfThinSlices) {
    const Fog fog{.density = 0.05f, .start = 4, .height_enabled = true, .height_falloff = 0.5f, .height_origin = 1};
    for (const auto& [eye, height] : {std::pair{0.0, 9.0}, {12.0, -3.0}, {2.0, 2.0}, {-2.0, -1.0}, {6.0, 1.5}}) {
        constexpr int slices = 100000;
        constexpr double distance = 40;
        double left = 1;
        for (int i = 0; i < slices; ++i) {
            const double t = 4 + (distance - 4) * (i + 0.5) / slices, y = eye + (height - eye) * t / distance;
            left *= 1 - 0.05 * std::exp(-0.5 * std::max(y - 1, 0.0)) * (distance - 4) / slices;
        }
        EXPECT_NEAR(fog_amount(distance, height, fog, eye), 1 - left, 1e-5) << eye << " to " << height;
    }
}

// Air, no wall: what is 100 m away shows through by more than half, and what is 20 m away nearly wholly.
TEST(EffectFog, TheDefaultsAreAir) {
    const Fog fog;
    EXPECT_LT(fog_amount(100, fog), 0.5);
    EXPECT_GT(fog_amount(100, fog), 0.2);
    EXPECT_LT(fog_amount(20, fog), 0.1);
}

TEST(EffectFog, RefusesAnEndThatDoesNotLieBeyondTheStart) {
    for (const float end : {3.0f, 5.0f}) {
        const Fog fog{.start = 5, .end = end};
        const std::string text = effect_info(fog).conflict(&fog);
        EXPECT_NE(text.find("must lie beyond start = 5"), std::string::npos) << text;
    }
    const Fog fine;
    EXPECT_EQ(effect_info(fine).conflict(&fine), "");
}

TEST(EffectFog, GpuMatchesReference) {
    const Case data;
    for (const Fog& fog : {Fog{}, Fog{.density = 0}, Fog{.density = 1e-5f, .start = 0, .end = 400}, Fog{.density = 3},
                           Fog{.density = 0.1f, .end = 20, .sky = true}, Fog{.horizon = 0}, Fog{.horizon = 60},
                           Fog{.height_enabled = true, .height_falloff = 0.4f, .height_origin = -2, .sky = true},
                           Fog{.density = 0.2f, .height_enabled = true, .height_falloff = 3, .height_origin = 3},
                           Fog{.height_enabled = true, .height_falloff = 0},
                           Fog{.density = 0.02f,
                           .end = 100,
                           .height_enabled = true,
                           .height_form = FogHeight::EndPoint,
                           .height_falloff = 0.4f,
                           .height_origin = -2,
                           .sky = true}}) {
        const ReferenceImage expected = test::scene_reference_of(fog, data.picture, data.options());
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            test::RunOptions options = data.options();
            options.kernels = stage;
            const auto fill = [&](Composer& composer) { composer.add(fog); };
            EXPECT_LE(test::worst_half_ulps(test::develop(fill, data.picture, options), expected), 2)
                << fog.density << " " << fog.height_enabled.on;
        }
    }
}

// A camera that looks level over a plain to the horizon: from the land into the sky no row differs by more than a step
// of the fade, and high up the sky is its own.
TEST(EffectFog, LandAndSkyMeetWithoutALine) {
    constexpr std::uint32_t height = 400;
    const ReferenceImage white = test::uniform(4, height, {1, 1, 1, 1});
    ReferenceImage depth{4, height};
    const Camera camera = test::look_at({0, 2, 0}, {0, 2, -1}, 1.0, 4.0 / height);
    const ReferenceCamera reference(camera);
    for (std::uint32_t y = 0; y < height; ++y) {
        const double down = -reference.world_direction(reference.view_position(0.5, (y + 0.5) / height, 1))[1];
        for (std::uint32_t x = 0; x < 4; ++x) depth.at(x, y).r = down > 0 ? 2 / down : 1e10;
    }
    const auto steepest = [&](const Fog& fog) {
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(fog); }, white, {.depth = &depth, .camera = camera});
        EXPECT_EQ(out.at(2, 0).r, 1) << "high up";
        double step = 0;
        for (std::uint32_t y = 1; y < height; ++y) step = std::max(step, std::abs(out.at(2, y).r - out.at(2, y - 1).r));
        return step;
    };
    EXPECT_GT(steepest({.color = {0, 0, 0}, .horizon = 0}), 0.9);
    EXPECT_LT(steepest({.color = {0, 0, 0}, .density = 0.02f, .end = 100}), 0.06);
    // Thin fog that has no end grows from 0.79 to 0.93 of itself within a row of land: 320 m, and 530 m away.
    EXPECT_LT(steepest({.color = {0, 0, 0}}), 0.15);
}

// The same distances as device depth, near to far and reversed.
TEST(EffectFog, GpuReadsEveryKindOfDepth) {
    const Case data;
    const Fog fog{.density = 0.05f};
    const ReferenceImage expected = test::scene_reference_of(fog, data.picture, data.options());
    for (const DepthKind kind : {DepthKind::Standard, DepthKind::Reversed}) {
        test::RunOptions options = data.options();
        options.camera.depth = kind;
        options.is_depth_planar = false;
        Matrix& p = options.camera.projection;
        if (kind == DepthKind::Reversed) {
            p[10] = -p[10] - 1;
            p[14] = -p[14];
        }
        ReferenceImage device = data.depth;
        for (Rgba& pixel : device.pixels) {
            const double distance = pixel.r;
            const double depth = (-distance * double{p[10]} + double{p[14]}) / distance;
            pixel.r = distance >= 1e9 ? (kind == DepthKind::Reversed ? 0 : 1) : double{static_cast<float>(depth)};
        }
        options.depth = &device;
        const auto fill = [&](Composer& composer) { composer.add(fog); };
        // Standard device depth in 32 bits resolves some 1e-4 of the distance at a thousand times `near`.
        EXPECT_LE(test::worst_difference(test::develop(fill, data.picture, options), expected), 2e-3)
            << static_cast<int>(kind);
    }
}

// Lean kernels of a perspective camera leave out what moves the rays of this one, which lean to the side, too.
TEST(EffectFog, GpuKnowsParallelRaysToo) {
    const Case data;
    test::RunOptions options = data.options();
    Matrix& p = options.camera.projection;
    p = {};
    p[0] = 0.05f;
    p[5] = -0.1f;
    p[8] = 0.02f;
    p[10] = -0.01f;
    p[15] = 1;
    const Fog fog{.density = 0.05f, .end = 400, .height_enabled = true, .height_origin = -5};
    const ReferenceImage expected = test::scene_reference_of(fog, data.picture, options);
    const auto fill = [&](Composer& composer) { composer.add(fog); };
    EXPECT_LE(test::worst_half_ulps(test::develop(fill, data.picture, options), expected), 2);
    EXPECT_GT(test::worst_half_ulps(test::develop(fill, data.picture, data.options()), expected), 20);
}

// Rays that run side by side are as long as the way from the plane of the eye, wherever in the picture they begin.
TEST(EffectFog, ParallelRaysOfAFlatWallAreEquallyLong) {
    const ReferenceImage white = test::uniform(16, 9, {1, 1, 1, 1}), depth = test::uniform(16, 9, {40, 0, 0, 1});
    Camera camera = test::look_at({0, 2, 0}, {0, 2, -1}, 1, 16.0 / 9);
    Matrix& p = camera.projection;
    p = {};
    p[0] = 0.02f;
    p[5] = -0.03f;
    p[10] = -0.01f;
    p[15] = 1;
    const Fog fog{.color = {0, 0, 0}, .density = 0.02f, .end = 100};
    const ReferenceImage out =
        test::develop([&](Composer& composer) { composer.add(fog); }, white, {.depth = &depth, .camera = camera});
    for (const Rgba& pixel : out.pixels) EXPECT_NEAR(pixel.r, 1 - fog_amount(40, fog), 1e-6);
}

TEST(EffectFog, GpuLeavesTheSkyBitForBit) {
    const Case data;
    for (const Fog& fog :
         {Fog{.density = 1000, .end = 6, .horizon = 0}, Fog{.density = 3, .height_enabled = true, .horizon = 0}}) {
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(fog); }, data.picture, data.options());
        ASSERT_EQ(out.pixels.size(), data.picture.pixels.size());
        for (std::uint32_t y = 0; y < 23; ++y)
            for (std::uint32_t x = 28; x < 37; ++x)
                EXPECT_EQ(out.at(x, y).r == data.picture.at(x, y).r, x > 33) << x << ", " << y;
    }
}

TEST(EffectFog, GpuWithoutDepthIsLeftOut) {
    const ReferenceImage picture = test::round_to_float(test::random_display(8, 8, 1));
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(Fog{.density = 9}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0);
}

}  // namespace
}  // namespace darkroom
