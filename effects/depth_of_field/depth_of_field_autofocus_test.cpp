// SPDX-License-Identifier: MIT
// A lens that focuses by itself: what it takes for the distance, and how it gets there.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/effects/depth_of_field.hpp>
#include <limits>
#include <string>
#include <vector>

#include "depth_of_field/depth_of_field_reference.hpp"
#include "depth_of_field/depth_of_field_test_shots.hpp"

namespace darkroom {
namespace {

using test::Shot;
using test::depth_of_field::camera_of;
using test::depth_of_field::height;
using test::depth_of_field::scene;
using test::depth_of_field::width;

constexpr Vec2 on_thing{0.47f, 0.5f}, on_wall{0.1f, 0.9f};

/// A large camera, so that circles are some pixels of a small picture wide.
DepthOfField focusing(Vec2 place, DepthOfFieldResolution resolution = DepthOfFieldResolution::Half) {
    return {.focus_distance = 0.7f,
            .autofocus = true,
            .autofocus_place = place,
            .f_stop = 2,
            .sensor_height = 480,
            .max_radius = 4,
            .resolution = resolution};
}
DepthOfField focused(double distance, DepthOfFieldResolution resolution = DepthOfFieldResolution::Half) {
    DepthOfField out = focusing(on_thing, resolution);
    out.autofocus = false;
    out.focus_distance = static_cast<float>(distance);
    return out;
}
test::Fill stack_of(const DepthOfField& field) {
    return [field](Composer& composer) { composer.add(field); };
}

Shot wall(double distance, double delta_time) {
    return {.color = test::uniform(8, 8, {1, 1, 1, 1}),
            .depth = test::uniform(8, 8, {distance, 0, 0, 1}),
            .camera = camera_of(8, 8),
            .delta_time = delta_time};
}
std::vector<Shot> changing(double first, double then, std::size_t frames, double delta_time) {
    std::vector<Shot> shots(frames + 1, wall(then, delta_time));
    shots[0] = wall(first, delta_time);
    return shots;
}

/// The dioptres that are sharp in each frame, as hosts are told.
std::vector<double> dioptres_of(const DepthOfField& field, std::vector<Shot> shots) {
    Composer composer(gpu::test::device(), {.frames_in_flight = 1});
    composer.add(field);
    Developer developer(gpu::test::device(), {.target = DevelopTarget::SceneLinear});
    std::vector<double> out(shots.size(), std::numeric_limits<double>::quiet_NaN());
    shots.push_back(shots.back());  // what the last one leaves is told with the next
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const Shot& shot = shots[i];
        const std::vector<float> color(shot.color.pixels.size() * 4, 1.0f),
            depth(shot.depth.pixels.size(), static_cast<float>(shot.depth.pixels[0].r));
        gpu::test::must(developer.develop(composer, {.extent = {shot.color.width, shot.color.height},
                                                     .color = color,
                                                     .depth = depth,
                                                     .camera = shot.camera,
                                                     .delta_time = shot.delta_time,
                                                     .frame_index = i}));
        const ValueReading reading = composer.value("depth_of_field");
        if (reading.numbers.empty()) continue;
        EXPECT_EQ(reading.numbers.size(), 3u);
        EXPECT_NEAR(double{reading.numbers[0]} * double{reading.numbers[1]}, 1, 1e-6);
        if (reading.frame_index < out.size()) out[reading.frame_index] = double{reading.numbers[1]};
    }
    return out;
}

constexpr std::array resolutions{DepthOfFieldResolution::Half, DepthOfFieldResolution::Full};

}  // namespace

TEST(EffectAutofocus, GpuIsSharpWhereThePlaceIs) {
    for (const DepthOfFieldResolution resolution : resolutions)
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
            const auto shown = [&](const DepthOfField& field, const Shot& shot) {
                return test::developed_sequence(stack_of(field), {&shot, 1}, kernels)[0];
            };
            const Shot things = scene(2, 20), sky = scene(2, 1e10);
            const ReferenceImage near = shown(focusing(on_thing, resolution), things),
                                 far = shown(focusing(on_wall, resolution), things);
            // The circle is worked out in another order.
            EXPECT_LE(test::worst_difference(near, shown(focused(2, resolution), things)), 0x1p-7);
            EXPECT_LE(test::worst_difference(far, shown(focused(20, resolution), things)), 0x1p-7);
            EXPECT_GT(test::worst_difference(near, far), 0.1);
            EXPECT_EQ(near.at(45, 64).r, 1);
            EXPECT_LE(
                test::worst_difference(shown(focusing(on_wall, resolution), sky), shown(focused(1e5, resolution), sky)),
                0x1p-7);
        }
}

TEST(EffectAutofocus, GpuMatchesReferenceFrameByFrame) {
    std::vector<Shot> shots{scene(2, 20), scene(8, 20), scene(3, 9), scene(1, 1e10), scene(1, 1e10)};
    for (Shot& shot : shots) shot.delta_time = 0.1;
    for (const DepthOfFieldResolution resolution : resolutions) {
        const DepthOfField field = focusing(on_thing, resolution);
        const auto expected = test::reference_sequence(stack_of(field), shots);
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
            const auto out = test::developed_sequence(stack_of(field), shots, kernels);
            for (std::size_t i = 0; i < shots.size(); ++i)
                // As without autofocus.
                EXPECT_LE(test::worst_difference(out[i], expected[i]), 0x1p-7) << i;
        }
    }
}

TEST(EffectAutofocus, GpuNeitherALeafNorAGapCounts) {
    const Shot shot = scene(2, 20);
    const auto focus = [&](std::size_t odd, double distance) {
        Shot other = shot;
        // Samples lie a pixel apart.
        for (std::size_t i = 0; i < odd; ++i)
            other.depth.at(45 + static_cast<std::uint32_t>(i % 5) - 2, 64 + static_cast<std::uint32_t>(i / 5) - 2).r =
                distance;
        const DepthOfField field = focusing({45.5f / width, 64.5f / height});
        const double expected = 1 / depth_of_field_reference_seen(field, other.depth);
        const ReferenceImage out = test::developed_sequence(stack_of(field), {&other, 1})[0];
        EXPECT_LE(test::worst_difference(out, test::developed_sequence(stack_of(focused(expected)), {&other, 1})[0]),
                  0x1p-7)
            << odd << " at " << distance;
        return expected;
    };
    for (const double distance : {0.4, 15.0, std::numeric_limits<double>::quiet_NaN(), 1e10}) {
        EXPECT_NEAR(focus(12, distance), 2, 1e-6);
        EXPECT_GT(std::abs(focus(13, distance) - 2), 1) << distance;
    }
}

TEST(EffectAutofocus, GpuFollowsOneCurveAtEveryFrameRate) {
    DepthOfField field = focusing(on_thing);
    field.autofocus_speed = 2;
    // Of 0.75 dioptres, 0.65 at constant speed.
    const auto left = [](double way) { return way < 0.65 ? 0.75 - way : 0.1 * std::exp((0.65 - way) / 0.1); };
    for (const double rate : {30.0, 60.0, 144.0, 1000.0}) {
        const auto frames = static_cast<std::size_t>(std::ceil(0.6 * rate));
        const auto nearer = dioptres_of(field, changing(4, 1, frames, 1 / rate)),
                   farther = dioptres_of(field, changing(1, 4, frames, 1 / rate));
        EXPECT_NEAR(nearer[0], 0.25, 1e-6) << "at once in the first frame";
        for (std::size_t i = 1; i <= frames; ++i) {
            const double seconds = static_cast<double>(i - 1) / rate;
            EXPECT_NEAR(nearer[i], 1 - left(2 * seconds), 1e-4) << rate << " after " << seconds;
            EXPECT_NEAR(farther[i], 0.25 + left(2 * seconds), 1e-4) << rate << " after " << seconds;
        }
    }
}

TEST(EffectAutofocus, GpuACutAJumpAndAStandstillAreSettled) {
    std::vector<Shot> cut = changing(4, 1, 3, 1.0 / 60), jump = cut, standstill = cut;
    cut[2].camera.is_cut = true;
    jump[2].camera.view[12] = 31;  // metres
    jump[3].camera.view[12] = 31;
    standstill[2].delta_time = -1;
    for (const std::vector<Shot>& shots : {cut, jump, standstill}) {
        const auto out = dioptres_of(focusing(on_thing), shots);
        EXPECT_NEAR(out[0], 0.25, 1e-6);
        EXPECT_NEAR(out[1], 0.25, 1e-6) << "it has not moved yet";
        EXPECT_NEAR(out[2], 1, 1e-6);
        EXPECT_NEAR(out[3], 1, 1e-6);
    }
}

TEST(EffectAutofocus, GpuSpeedZeroHoldsStillAndDistancesHaveEnds) {
    DepthOfField held = focusing(on_thing);
    held.autofocus_speed = 0;
    EXPECT_NEAR(dioptres_of(held, changing(4, 1, 8, 1)).back(), 0.25, 1e-6);
    EXPECT_EQ(effect_info(held).pre_roll(&held, 1.0 / 60), 1'000'000'000u);
    EXPECT_NEAR(dioptres_of(focusing(on_thing), {wall(0.02, 0.1)})[0], 10, 1e-5);
    EXPECT_NEAR(dioptres_of(focusing(on_thing), {wall(1e10, 0.1)})[0], 1e-5, 1e-9);
}

TEST(EffectAutofocus, TwoStepsAreOneThatIsAsLongAsBoth) {
    for (const double seconds : {0.01, 0.2, 0.5})
        for (const double target : {0.3, 1.05, 4.0}) {
            const double half = depth_of_field_reference_moved(1, target, 3, seconds / 2);
            EXPECT_NEAR(depth_of_field_reference_moved(half, target, 3, seconds / 2),
                        depth_of_field_reference_moved(1, target, 3, seconds), 1e-12);
        }
}

TEST(EffectAutofocus, PreRollIsEnoughAndThereIsNoneWithoutIt) {
    const DepthOfField off = focused(3), on = focusing(on_thing);
    EXPECT_EQ(effect_info(off).pre_roll(&off, 1.0 / 60), 0u);
    for (const double delta_time : {1.0 / 24, 1.0 / 60}) {
        const std::uint32_t frames = effect_info(on).pre_roll(&on, delta_time);
        const auto left_after = [&](double count) {
            return depth_of_field_reference_moved(10, 1e-5, double{on.autofocus_speed}, (count - 1) * delta_time);
        };
        EXPECT_LE(left_after(frames), 1.02e-3);
        EXPECT_GT(left_after(frames - 3), 1e-3) << "and no more than that";
    }
}

TEST(EffectAutofocus, GpuTakesTheDepthOfADevice) {
    Shot planar = scene(2, 20), reversed = planar;
    Camera& camera = reversed.camera;
    camera.depth = DepthKind::Reversed;
    camera.far_distance = std::numeric_limits<float>::infinity();
    camera.projection[10] = 0;
    camera.projection[14] = camera.near_distance;
    for (Rgba& depth : reversed.depth.pixels) depth.r = double{camera.near_distance} / depth.r;
    const auto developed = [&](const Shot& shot, bool is_planar) {
        return test::develop(stack_of(focusing(on_wall)), shot.color,
                             {.depth = &shot.depth, .is_depth_planar = is_planar, .camera = shot.camera});
    };
    EXPECT_LE(test::worst_difference(developed(reversed, false), developed(planar, true)), 0x1p-8);
}

TEST(EffectAutofocus, GpuRaysSideBySideHaveNoLens) {
    Shot shot = scene(2, 20);
    shot.camera.projection[11] = 0;
    shot.camera.projection[15] = 1;
    for (const DepthOfFieldResolution resolution : resolutions)
        EXPECT_EQ(test::worst_difference(
                      test::developed_sequence(stack_of(focusing(on_thing, resolution)), {&shot, 1})[0], shot.color),
                  0);
}

TEST(EffectAutofocus, WithoutItThereAreNoPassesOfIt) {
    const auto passes_of = [](const DepthOfField& field) {
        Composer composer(Device::assumed());
        composer.add(field);
        const ImageUse image{VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
        const Plan plan = gpu::test::must(composer.plan(
            {.max_extent = {1920, 1080}, .color = image, .depth = {VK_FORMAT_D32_SFLOAT}, .target = image}));
        std::vector<std::string> out;
        for (const PlanPass& pass : plan.passes) out.push_back(pass.name);
        return out;
    };
    std::vector<std::string> on = passes_of(focusing(on_thing));
    for (const char* const name : {"depth_of_field.focus", "depth_of_field.focused"})
        EXPECT_EQ(std::erase(on, name), 1u) << name;
    EXPECT_EQ(on, passes_of(focused(3)));
}

}  // namespace darkroom
