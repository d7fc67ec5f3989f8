// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/motion_blur.hpp>
#include <limits>
#include <vector>

#include "develop/test_sequence.hpp"
#include "motion_blur/motion_blur_reference.hpp"

namespace darkroom {
namespace {

using test::Shot;

// Of this height a point may smear by 12 pixels to either side.
constexpr std::uint32_t width = 128, height = 400;
constexpr std::uint32_t left = 48, right = 80, top = 120, bottom = 280;  // of the thing in front

test::Fill stack_of(const MotionBlur& blur) {
    return [blur](Composer& composer) { composer.add(blur); };
}
ReferenceImage on_gpu(const MotionBlur& blur, const Shot& shot, KernelStage kernels = KernelStage::Auto) {
    return test::developed_sequence(stack_of(blur), {&shot, 1}, kernels)[0];
}
ReferenceImage on_cpu(const MotionBlur& blur, const Shot& shot) {
    return test::reference_sequence(stack_of(blur), {&shot, 1})[0];
}
constexpr MotionBlur full{.shutter_angle = 360, .samples = 32, .resolution = MotionBlurResolution::Full};
constexpr MotionBlur half{.shutter_angle = 360, .samples = 32, .resolution = MotionBlurResolution::Half};

bool is_in_front(std::uint32_t x, std::uint32_t y) { return x >= left && x < right && y >= top && y < bottom; }

/// A red thing 5 m away before a striped wall of green and blue, 20 m away, each with a velocity.
Shot scene(const std::array<double, 2>& of_thing, const std::array<double, 2>& of_wall) {
    Shot shot{.color = ReferenceImage(width, height),
              .depth = ReferenceImage(width, height),
              .velocity = ReferenceImage(width, height)};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const bool is_thing = is_in_front(x, y);
            const auto& velocity = is_thing ? of_thing : of_wall;
            shot.color.at(x, y) = is_thing ? Rgba{1, 0, 0, 1} : Rgba{0, (x / 2 + y / 2) % 2 == 0 ? 0.75 : 0.25, 0.5, 1};
            shot.depth.at(x, y) = {is_thing ? 5.0 : 20.0, 0, 0, 1};
            shot.velocity.at(x, y) = {velocity[0], velocity[1], 0, 1};
        }
    return shot;
}

TEST(EffectMotionBlur, GpuMatchesReference) {
    // Reaches of whole texels: the place of every sample is then the same in floats and in doubles.
    for (const Shot& shot : {scene({16, 8}, {0, 0}), scene({0, 0}, {-16, 4}), scene({8, 0}, {0, 16})})
        for (const MotionBlur& blur : {full, half}) {
            const ReferenceImage expected = on_cpu(blur, shot);
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
                // Four writes in half precision, each cut off by up to 2^-10.
                EXPECT_LE(test::worst_difference(on_gpu(blur, shot, kernels), expected), 0x1p-8);
        }
}

/// The share of pixels that differ by more than `difference`.
double share_beyond(const ReferenceImage& a, const ReferenceImage& b, double difference) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        count += std::max({std::abs(a.pixels[i].r - b.pixels[i].r), std::abs(a.pixels[i].g - b.pixels[i].g),
                           std::abs(a.pixels[i].b - b.pixels[i].b)}) > difference;
    return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

/// A room that a camera walks through and looks about in, seen without velocity image.
Shot walk() {
    Shot shot = scene({0, 0}, {0, 0});
    shot.velocity = {};
    const double aspect = double{width} / height;
    shot.camera = test::look_at({0.2, 1.6, 0.1}, {0.5, 1.5, -5}, 0.9, aspect);
    const Camera before = test::look_at({0.1, 1.55, 0.3}, {0.42, 1.48, -5}, 0.9, aspect);
    shot.camera.previous_view = before.view;
    return shot;
}

TEST(EffectMotionBlur, GpuMatchesReferenceWhereTheCameraMoves) {
    const Shot shot = walk();
    for (const MotionBlur& blur : {full, half}) {
        const ReferenceImage out = on_gpu(blur, shot), expected = on_cpu(blur, shot);
        // A motion in half precision puts a sample of thirty-two beside its texel now and then: 1/32 of a stripe.
        EXPECT_LE(share_beyond(out, expected, 0x1p-8), 0.2);
        EXPECT_LE(share_beyond(out, expected, 0x1p-4), 0.002);
        EXPECT_GT(share_beyond(out, shot.color, 0x1p-4), 0.3) << "it does something";
    }
}

/// Moved by half a pixel, this frame and the one before in opposite ways.
Shot jittered(Shot shot) {
    Camera& camera = shot.camera;
    camera.jitter = {0.5f, -0.4375f};
    camera.previous_jitter = {-0.5f, 0.5f};
    camera.projection = darkroom::jittered(camera.projection, camera.jitter, {width, height}, camera.is_y_down);
    camera.previous_projection =
        darkroom::jittered(camera.previous_projection, camera.previous_jitter, {width, height}, camera.is_y_down);
    return shot;
}

TEST(EffectMotionBlur, AStillCamerasJitterIsNoMotion) {
    Shot still = walk();
    still.camera.previous_view = still.camera.view;
    for (MotionBlur blur : {full, half}) {
        blur.shutter_angle = 720;  // or at half size a motion of a pixel and a half would not be smeared
        EXPECT_LE(share_beyond(on_gpu(blur, jittered(still)), on_gpu(blur, still), 0x1p-8), 0);
    }
}

TEST(EffectMotionBlur, AWalkingCamerasJitterIsTakenOff) {
    const Shot shot = jittered(walk());
    for (const MotionBlur& blur : {full, half}) {
        const ReferenceImage out = on_gpu(blur, shot), expected = on_cpu(blur, shot);
        EXPECT_LE(share_beyond(out, expected, 0x1p-8), 0.2);
        EXPECT_LE(share_beyond(out, expected, 0x1p-4), 0.002);
    }
}

// Every line and column of its own: a row too few at an odd edge is seen.
TEST(EffectMotionBlur, OddEdgesOfAPictureThatIsNowhereTheSame) {
    for (const VkExtent2D extent : {VkExtent2D{33, 217}, VkExtent2D{46, 203}, VkExtent2D{31, 218}, VkExtent2D{1, 217}})
        for (const MotionBlur& blur : {full, half}) {
            const ReferenceImage random = test::random_display(extent.width, extent.height, 9);
            Shot shot{.color = test::round_to_half(random),
                      .depth = ReferenceImage(extent.width, extent.height),
                      .velocity = ReferenceImage(extent.width, extent.height)};
            for (std::uint32_t y = 0; y < extent.height; ++y)
                for (std::uint32_t x = 0; x < extent.width; ++x) {
                    shot.depth.at(x, y) = {4.0 + x / 8 + y / 16, 0, 0, 1};
                    shot.velocity.at(x, y) = {x + 1 < extent.width ? 4.0 : -8.0, y + 1 < extent.height ? 0.0 : 8.0, 0,
                                              1};
                }
            EXPECT_LE(test::worst_difference(on_gpu(blur, shot), on_cpu(blur, shot)), 0x1p-8)
                << extent.width << "x" << extent.height;
        }
}

// Occlusion of no strength, before it in the stack, asks for the distances of half the size. Some pixels are sprites,
// whose normals have no length: such distances have a sign.
TEST(EffectMotionBlur, TheDistancesOfAnotherEffectGiveTheSamePicture) {
    const EffectInfo* const ssao = find_effect("ssao");
    if (ssao == nullptr) GTEST_SKIP() << "this build has no ssao";
    const auto numbers = [](const ReferenceImage& image, std::size_t channels) {
        std::vector<float> out;
        for (const Rgba& p : image.pixels)
            for (std::size_t i = 0; i < channels; ++i)
                out.push_back(static_cast<float>(std::array{p.r, p.g, p.b, p.a}[i]));
        return out;
    };
    for (const bool has_velocity : {false, true}) {
        Shot shot = has_velocity ? scene({16, 8}, {-7, 3}) : walk();
        for (std::uint32_t x = 0; x < width; ++x) shot.depth.at(x, 0) = {1e10, 0, 0, 1};
        shot.depth.at(20, 60) = {std::numeric_limits<double>::quiet_NaN(), 0, 0, 1};
        ReferenceImage normals(width, height);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) normals.at(x, y) = {0, 0, y % 32 < 8 ? 0.0 : 1.0, 1};
        const std::vector<float> color = numbers(shot.color, 4), depth = numbers(shot.depth, 1),
                                 normal = numbers(normals, 3), velocity = numbers(shot.velocity, 2);
        const auto develop = [&](bool has_ssao, bool has_normals) {
            Composer composer(gpu::test::device(), {.frames_in_flight = 1});
            if (has_ssao) gpu::test::must(composer.set(composer.add(*ssao, nullptr), "intensity", 0.0));
            composer.add(half);
            Developer developer(gpu::test::device(), {.target = DevelopTarget::SceneLinear});
            DevelopInput input{.extent = {width, height}, .color = color, .depth = depth, .camera = shot.camera};
            if (has_normals) input.normals = normal;
            if (has_velocity) input.velocity = velocity;
            return gpu::test::must(developer.develop(composer, input)).pixels;
        };
        const auto alone = develop(false, false);
        for (const bool has_normals : {false, true}) {
            const auto shared = develop(true, has_normals);
            ASSERT_EQ(shared.size(), alone.size());
            float worst = 0;
            for (std::size_t i = 0; i < alone.size(); ++i) worst = std::max(worst, std::abs(shared[i] - alone[i]));
            EXPECT_LE(worst, 0x1p-10F) << has_velocity << has_normals;
        }
    }
}

TEST(EffectMotionBlur, TheCamerasMotionIsAVelocity) {
    Shot by_camera = walk(), given = by_camera;
    given.velocity = ReferenceImage(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto [right_px, down_px] = motion_blur_reference_velocity(
                given.camera, given.color, (x + 0.5) / width, (y + 0.5) / height, given.depth.at(x, y).r);
            given.velocity.at(x, y) = {right_px, down_px, 0, 1};
        }
    // A point of the wall by hand: from where it was to where it is.
    const Camera& camera = by_camera.camera;
    const ReferenceCamera now(camera);
    const auto place = now.view_position(0.25, 0.75, 20);
    Double3 world = now.world_direction(place);
    for (std::size_t i = 0; i < 3; ++i) world[i] += now.eye[i];
    Camera earlier = camera;
    earlier.view = camera.previous_view;
    const ReferenceCamera before(earlier);
    for (std::size_t i = 0; i < 3; ++i) world[i] -= before.eye[i];
    const auto was = before.uv(before.view_direction(world));
    const auto moved = motion_blur_reference_velocity(camera, given.color, 0.25, 0.75, 20);
    EXPECT_NEAR(moved[0], (was[0] - 0.25) * width, 1e-9);
    EXPECT_NEAR(moved[1], (was[1] - 0.75) * height, 1e-9);
    EXPECT_GT(std::hypot(moved[0], moved[1]), 1);
    EXPECT_LE(share_beyond(on_gpu(full, by_camera), on_gpu(full, given), 0x1p-4), 0.002);
}

TEST(EffectMotionBlur, AStillThingDoesNotSmearOverAMovingWall) {
    const Shot shot = scene({0, 0}, {20, 0});
    for (const MotionBlur& blur : {full, half}) {
        const bool is_half = blur.resolution == MotionBlurResolution::Half;
        for (const ReferenceImage& out : {on_gpu(blur, shot), on_cpu(blur, shot)})
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const Rgba& pixel = out.at(x, y);
                    if (!is_in_front(x, y)) {
                        ASSERT_EQ(pixel.r, 0) << "of the thing nothing is outside: " << x << "," << y;
                        continue;
                    }
                    // At half size bilinear sampling gives the outermost pixels up to 7/16 of the wall.
                    const std::uint32_t rim = is_half ? 1 : 0;
                    const bool is_rim = x < left + rim || x + rim >= right || y < top + rim || y + rim >= bottom;
                    // A sample at the centre of a texel is as exact as its uv, a product in float.
                    constexpr double of_neighbour = 0x1p-15;
                    ASSERT_GE(pixel.r, is_rim ? 0.56 : 1 - of_neighbour) << x << "," << y;
                    ASSERT_LE(pixel.g, is_rim ? 0.44 : of_neighbour) << x << "," << y;
                }
        // The wall itself has lost its stripes, next to the thing as well.
        const ReferenceImage out = on_gpu(blur, shot);
        for (const std::uint32_t x : {20U, 30U, 46U, 81U, 100U}) EXPECT_NEAR(out.at(x, 200).g, 0.5, 0.13) << x;
    }
}

TEST(EffectMotionBlur, AMovingThingSmearsBeyondItsEdgeOverAStillWall) {
    constexpr double reach = 10;
    const Shot shot = scene({2 * reach, 0}, {0, 0});
    for (const MotionBlur& blur : {full, half})
        for (const ReferenceImage& out : {on_gpu(blur, shot), on_cpu(blur, shot)}) {
            // The part of the time that a thing of this speed covers the place: a mean over lines, as samples are
            // scattered.
            const auto red = [&](std::uint32_t x) {
                double sum = 0;
                for (std::uint32_t y = 150; y < 250; ++y) sum += out.at(x, y).r / 100;
                return sum;
            };
            for (int way = -9; way <= 9; ++way) {
                // At half size a quarter of the sharp thing that its outermost pixel does not cover shows through.
                const bool is_rim = way == -1 && blur.resolution == MotionBlurResolution::Half;
                const double expected = 0.5 - (way + 0.5) / (2 * reach) + (is_rim ? 0.125 : 0);
                EXPECT_NEAR(red(static_cast<std::uint32_t>(static_cast<int>(right) + way)), expected, 0.1) << way;
                EXPECT_NEAR(red(static_cast<std::uint32_t>(static_cast<int>(left) - 1 - way)), expected, 0.1) << way;
            }
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x)
                    if (x + 13 < left || x > right + 13 || y + 3 < top || y > bottom + 3) {
                        ASSERT_EQ(out.at(x, y).g, shot.color.at(x, y).g) << "the wall stays sharp: " << x << "," << y;
                    }
        }
}

TEST(EffectMotionBlur, FlatFieldsStayFlat) {
    Shot shot = scene({16, 8}, {-7, 3});
    shot.color = test::uniform(width, height, {2, 0.5, 0.25, 1});
    for (const MotionBlur& blur : {full, half}) {
        EXPECT_LE(test::worst_difference(on_cpu(blur, shot), shot.color), 1e-12);
        EXPECT_LE(test::worst_difference(on_gpu(blur, shot), shot.color), 0x1p-7);
    }
}

TEST(EffectMotionBlur, ReachIsInHundredthsOfTheHeightAndByTheShutter) {
    Shot shot = scene({500, 0}, {0, 0});
    const auto smeared_to = [&](const MotionBlur& blur) {
        const ReferenceImage out = on_gpu(blur, shot);
        std::uint32_t x = right;
        while (out.at(x, 200).r > 0.02) ++x;
        return static_cast<int>(x) - static_cast<int>(right);
    };
    MotionBlur blur = full;
    EXPECT_NEAR(smeared_to(blur), 12, 2) << "3 % of 400";
    blur.max_radius = 1.5f;
    EXPECT_NEAR(smeared_to(blur), 6, 2);
    shot = scene({8, 0}, {0, 0});
    EXPECT_NEAR(smeared_to(full), 4, 1);
    blur = full;
    blur.shutter_angle = 720;
    EXPECT_NEAR(smeared_to(blur), 8, 1);
}

TEST(EffectMotionBlur, WithoutMotionOrAfterACutThePictureIsAsItWas) {
    const Shot still = scene({0, 0}, {0, 0});
    Shot cut = scene({16, 8}, {-7, 3});
    cut.camera.is_cut = true;
    for (const MotionBlur& blur : {full, half})
        for (const Shot& shot : {still, cut}) {
            EXPECT_EQ(test::worst_difference(on_gpu(blur, shot), shot.color), 0);
            EXPECT_EQ(test::worst_difference(on_cpu(blur, shot), shot.color), 0);
        }
    const MotionBlur off{.shutter_angle = 0}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

// Of a camera that jumped the velocities say nothing, whoever made them. Where the check is off, everything smears.
TEST(EffectMotionBlur, NothingSmearsWhereTheCameraJumped) {
    Shot first = scene({16, 8}, {-7, 3}), second = first;
    first.camera = test::look_at({0, 0, 0}, {0, 0, -1}, 0.9, double{width} / height);
    second.camera = test::look_at({0, 0, 0}, {1, 0, 0}, 0.9, double{width} / height);
    for (Shot* const shot : {&first, &second}) shot->camera.depth = DepthKind::Planar;
    for (const bool is_checked : {true, false}) {
        if (!is_checked) second.camera.jump_angle = std::numeric_limits<float>::infinity();
        for (const MotionBlur& blur : {full, half}) {
            const std::vector<Shot> shots{first, second};
            for (const auto& out :
                 {test::developed_sequence(stack_of(blur), shots), test::reference_sequence(stack_of(blur), shots)}) {
                EXPECT_GT(share_beyond(out[0], first.color, 0x1p-4), 0.3) << "the first frame has none before it";
                EXPECT_EQ(share_beyond(out[1], second.color, 0x1p-4) > 0.3, !is_checked);
                EXPECT_EQ(test::worst_difference(out[1], second.color) == 0, is_checked);
            }
        }
    }
}

// A sky of columns of one pixel, seen by a camera that turns, its far plane at infinity: at half size a texel is the
// mean of what it covers, whose depth is 0, or 1, as that of all sky is. With an odd number of columns, too.
TEST(EffectMotionBlur, TheSkyIsTakenWholeInDeviceDepth) {
    for (const DepthKind kind : {DepthKind::Standard, DepthKind::Reversed})
        for (const std::uint32_t columns : {128U, 127U}) {
            const bool is_reversed = kind == DepthKind::Reversed;
            ReferenceImage sky(columns, height), depth(columns, height, {is_reversed ? 0.0 : 1.0, 0, 0, 1});
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < columns; ++x) sky.at(x, y) = {x % 2 == 0 ? 1.0 : 0.0, 0, 0, 1};
            const double aspect = static_cast<double>(columns) / height;
            Camera camera = test::look_at({0, 0, 0}, {0, 0, -1}, 0.9, aspect);
            camera.depth = kind;
            camera.far_distance = std::numeric_limits<float>::infinity();
            // z_clip = near or near - distance, w = distance.
            camera.projection[10] = is_reversed ? 0.0f : -1.0f;
            camera.projection[14] = is_reversed ? camera.near_distance : -camera.near_distance;
            camera.previous_projection = camera.projection;
            camera.previous_view = test::look_at({0, 0, 0}, {0.01, 0, -1}, 0.9, aspect).view;
            const ReferenceImage out =
                test::develop(stack_of(half), sky, {.depth = &depth, .is_depth_planar = false, .camera = camera});
            ASSERT_EQ(out.pixels.size(), sky.pixels.size());
            for (std::uint32_t x = 20; x < columns - 20; ++x)
                ASSERT_NEAR(out.at(x, 200).r, 0.5, 0.02) << columns << " columns, at " << x;
        }
}

TEST(EffectMotionBlur, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const MotionBlur& blur : {full, half}) {
        Shot shot = scene({16, 8}, {-7, 3});
        shot.color.at(60, 200) = {nan, infinity, -infinity, 1};
        shot.depth.at(20, 60) = {nan, 0, 0, 1};
        shot.velocity.at(100, 350) = {nan, infinity, 0, 1};
        const ReferenceImage out = on_gpu(blur, shot), clean = on_gpu(blur, scene({16, 8}, {-7, 3}));
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Rgba& pixel = out.at(x, y);
                const bool is_own = x == 60 && y == 200;
                EXPECT_TRUE(is_own || (std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b)));
                const auto is_far = [&](int from_x, int from_y, int reach) {
                    return std::max(std::abs(static_cast<int>(x) - from_x), std::abs(static_cast<int>(y) - from_y)) >
                           reach;
                };
                // A false velocity turns the samples of the tiles around, and no more.
                if (is_far(60, 200, 14) && is_far(20, 60, 14) && is_far(100, 350, 48)) {
                    EXPECT_EQ(pixel.g, clean.at(x, y).g) << x << "," << y;
                }
            }
    }
}

TEST(EffectMotionBlur, OddSizesAndASinglePixel) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{1, 7}, VkExtent2D{9, 1}, VkExtent2D{31, 217}})
        for (const MotionBlur& blur : {full, half}) {
            Shot shot{.color = test::round_to_float(test::random_display(extent.width, extent.height, 3)),
                      .depth = test::uniform(extent.width, extent.height, {4, 0, 0, 1}),
                      .velocity = test::uniform(extent.width, extent.height, {8, -4, 0, 1})};
            EXPECT_LE(test::worst_difference(on_gpu(blur, shot), on_cpu(blur, shot)), 0x1p-8)
                << extent.width << "x" << extent.height;
        }
}

}  // namespace
}  // namespace darkroom
