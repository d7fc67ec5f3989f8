// SPDX-License-Identifier: MIT
#include "render/renderer.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D small_frame{64, 48};

void expect_color(const Pixels& pixels, std::uint32_t x, std::uint32_t y, const std::array<float, 4>& wanted,
                  float tolerance = 0) {
    const std::array<float, 4> found = pixels.at(x, y);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(found[c], wanted[c], tolerance) << x << ", " << y << ", " << c;
}

TEST(RenderGpuRenderer, AnEmptyScenePictureIsItsBackground) {
    scene::Scene scene;
    scene.environment.background = {0.25F, 0.5F, 2};
    Renderer renderer = renderer_for({.extent = small_frame}, {}, scene);
    const Shot shot = shoot(renderer, snapshot_of(small_frame));
    for (std::uint32_t y = 0; y < small_frame.height; y += 7) {
        for (std::uint32_t x = 0; x < small_frame.width; x += 7) {
            expect_color(shot.color, x, y, {0.25F, 0.5F, 2, 1});
            EXPECT_EQ(shot.depth.at(x, y)[0], 1e10F);
            EXPECT_EQ(shot.normals.at(x, y)[0], 0);
            EXPECT_NEAR(shot.velocity.at(x, y)[0], 0, 1e-4F);
        }
    }
    EXPECT_EQ(renderer.counters().draw_calls, 0U);
}

TEST(RenderGpuRenderer, ABoxIsWhereArithmeticPutsItAndKeepsHdr) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    // At distance 4 the picture is 8 m high: 6 pixels a metre. x from 0 to 2, y from 1 to 3 (upwards).
    add_box(snapshot, {0, 1, -5}, {2, 3, -4}, plain({4, 0.5F, 0, 1}));
    const Shot shot = shoot(renderer, snapshot);
    for (std::uint32_t y = 0; y < small_frame.height; ++y) {
        for (std::uint32_t x = 0; x < small_frame.width; ++x) {
            const bool is_inside = x >= 32 && x < 44 && y >= 6 && y < 18;
            // The bottom and left sides of a box right of and above the middle are seen, too.
            const bool is_clear = x < 30 || x >= 46 || y < 4 || y >= 20;
            if (is_inside) {
                expect_color(shot.color, x, y, {4, 0.5F, 0, 1});
                EXPECT_NEAR(shot.depth.at(x, y)[0], 4, 1e-4F);
                EXPECT_NEAR(shot.normals.at(x, y)[2], 1, 1e-3F);
            } else if (is_clear) {
                EXPECT_LT(shot.color.at(x, y)[0], 1) << x << ", " << y;
                EXPECT_EQ(shot.depth.at(x, y)[0], 1e10F);
            }
        }
    }
}

TEST(RenderGpuRenderer, WhatShadersCannotReachIsToldBeforeItIsBound) {
    gpu::Context& context = gpu::test::context();
    const VkDeviceSize before = std::exchange(context.traits.max_storage_range, 4096);
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    add_box(snapshot, {0, 1, -5}, {2, 3, -4}, plain({4, 0.5F, 0, 1}));
    EXPECT_TRUE(renderer.prepare(snapshot));
    snapshot.joints.resize(33, scene::mat4(1));
    const Result<> refused = renderer.prepare(snapshot);
    context.traits.max_storage_range = before;
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text,
              "the scene is too large for " + context.info.name + ": joints need 4224 bytes, shaders reach 4096");
    EXPECT_TRUE(renderer.prepare(snapshot));
}

TEST(RenderGpuRenderer, DepthIsPlanarDistanceOfASlantedFloor) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    add_box(snapshot, {-100, -3, -99}, {100, -2, -0.2F}, plain(vec4(1)));
    const Shot shot = shoot(renderer, snapshot);
    // A shifted vertex moves the floor up or down the picture.
    const float snapped = static_cast<float>(gpu::test::vertex_shift()) / 24;
    for (std::uint32_t y = 26; y < small_frame.height; ++y) {
        // The ray through a pixel's centre meets y = -2 where -2 = -distance * slope.
        const float slope = (static_cast<float>(y) + 0.5F) / 24 - 1;
        const float distance = 2 / slope;
        if (distance > 98) continue;
        for (const std::uint32_t x : {0U, 31U, 63U}) {
            EXPECT_NEAR(shot.depth.at(x, y)[0] / distance, 1, 2e-5F + snapped / slope) << y;
            EXPECT_NEAR(shot.normals.at(x, y)[1], 1, 1e-3F);
        }
    }
}

TEST(RenderGpuRenderer, OrthographicDepthIsPlanarDistance) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    snapshot.camera = front_camera(small_frame, 8);
    add_wall(snapshot, 37, 2, plain(vec4(1)));
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_NEAR(shot.depth.at(32, 24)[0], 37, 1e-3F);
    EXPECT_NEAR(shot.depth.at(21, 13)[0], 37, 1e-3F);
    EXPECT_EQ(shot.depth.at(18, 24)[0], 1e10F);
}

TEST(RenderGpuRenderer, VelocityIsThePreviousPlaceMinusTheOneOfNow) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    // 6 pixels a metre at distance 4: it came from 0.5 m left and 0.25 m below.
    scene::Instance& box = add_wall(snapshot, 4, 1, plain(vec4(1)));
    box.previous_world = glm::translate(mat4(1), {-0.5F, -0.25F, 0}) * box.world;
    const Shot shot = shoot(renderer, snapshot);
    for (const std::uint32_t x : {27U, 32U, 37U}) {
        EXPECT_NEAR(shot.velocity.at(x, 24)[0], -3, 0.01F);
        EXPECT_NEAR(shot.velocity.at(x, 24)[1], 1.5F, 0.01F);
    }
    EXPECT_NEAR(shot.velocity.at(2, 2)[0], 0, 1e-4F);
}

TEST(RenderGpuRenderer, VelocityOfAMovingCameraIsTheProjectedDifference) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    add_wall(snapshot, 4, 6, plain(vec4(1)));
    const mat4 turn = glm::rotate(mat4(1), glm::radians(2.0F), vec3(0.3F, 1, 0.2F));
    snapshot.camera.previous_view = turn * glm::translate(mat4(1), vec3(0.1F, 0.05F, 0.2F));
    const Shot shot = shoot(renderer, snapshot);
    for (std::uint32_t y = 3; y < small_frame.height; y += 10) {
        for (std::uint32_t x = 3; x < small_frame.width; x += 10) {
            const vec2 pixel(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const vec4 point((pixel.x - 32) / 24 * 4, -(pixel.y - 24) / 24 * 4, -4, 1);
            const vec4 clip = snapshot.camera.projection * snapshot.camera.previous_view * point;
            const vec2 before = (vec2(clip) / clip.w * 0.5F + 0.5F) * vec2(small_frame.width, small_frame.height);
            EXPECT_NEAR(shot.velocity.at(x, y)[0], before.x - pixel.x, 0.01F);
            EXPECT_NEAR(shot.velocity.at(x, y)[1], before.y - pixel.y, 0.01F);
        }
    }
}

TEST(RenderGpuRenderer, NearerSurfacesHideOthersWhateverTheOrder) {
    Renderer renderer = renderer_for({.extent = small_frame});
    for (const bool is_far_first : {false, true}) {
        scene::Snapshot snapshot = snapshot_of(small_frame);
        const float first = is_far_first ? 8.0F : 4.0F, second = is_far_first ? 4.0F : 8.0F;
        add_wall(snapshot, first, 6, plain(is_far_first ? vec4(0, 1, 0, 1) : vec4(1, 0, 0, 1)));
        add_wall(snapshot, second, 6, plain(is_far_first ? vec4(1, 0, 0, 1) : vec4(0, 1, 0, 1)));
        snapshot.materials[1].surface.is_double_sided = true;  // another batch
        expect_color(shoot(renderer, snapshot).color, 32, 24, {1, 0, 0, 1});
    }
}

TEST(RenderGpuRenderer, AThousandBoxesAreOneCall) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    for (int i = 0; i < 1000; ++i) {
        const vec3 low(-2 + 0.1F * static_cast<float>(i % 40), -1 + 0.08F * static_cast<float>(i / 40), -4);
        add_box(snapshot, low, low + 0.05F, plain(vec4(vec3(static_cast<float>(i) / 1000), 1)));
    }
    add_wall(snapshot, -20, 1, plain(vec4(1)));
    shoot(renderer, snapshot);
    EXPECT_EQ(renderer.counters().draw_calls, 1U);
    EXPECT_EQ(renderer.counters().instances, 1000U);
    EXPECT_EQ(renderer.counters().culled, 1U) << "what is behind the camera";
}

TEST(RenderGpuRenderer, InstancesOfOneCallHaveTheirOwnFactorsAndPlaces) {
    Renderer renderer = renderer_for({.extent = small_frame});
    scene::Snapshot snapshot = snapshot_of(small_frame);
    add_box(snapshot, {-3, -1, -5}, {-1, 1, -4}, plain({1, 0, 0, 1}));
    add_box(snapshot, {1, -1, -5}, {3, 1, -4}, plain({0, 0, 1, 1}));
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_EQ(renderer.counters().draw_calls, 1U);
    expect_color(shot.color, 18, 24, {1, 0, 0, 1});
    expect_color(shot.color, 46, 24, {0, 0, 1, 1});
}

TEST(RenderGpuRenderer, AnySizeWorks) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 7}, {1, 513}, {513, 1}}) {
        for (const std::uint32_t samples : {1U, 4U}) {
            if ((gpu::test::context().traits.sample_counts & samples) == 0) continue;
            Renderer renderer = renderer_for({.extent = extent, .samples = samples});
            scene::Snapshot snapshot = snapshot_of(extent);
            add_wall(snapshot, 2, 2000, plain({0.5F, 2, 0.25F, 1}));
            const Shot shot = shoot(renderer, snapshot);
            expect_color(shot.color, 0, 0, {0.5F, 2, 0.25F, 1}, 1e-3F);
            expect_color(shot.color, extent.width - 1, extent.height - 1, {0.5F, 2, 0.25F, 1}, 1e-3F);
            EXPECT_NEAR(shot.depth.at(extent.width - 1, extent.height - 1)[0], 2, 1e-4F);
        }
    }
}

TEST(RenderGpuRenderer, WhatTheDeviceLacksIsRefusedInOneLine) {
    const auto refusal = [](const RenderDesc& desc) {
        const Result<Renderer> made = Renderer::create(gpu::test::device(), {}, {}, desc);
        return made ? std::string() : made.error().text;
    };
    const std::string name = gpu::test::device().info().name;
    const std::string limit = std::to_string(gpu::test::context().traits.max_image_dimension);
    EXPECT_EQ(refusal({.extent = {0, 3}}), "size 0x3: " + name + " allows 1x1 to " + limit + "x" + limit);
    EXPECT_NE(refusal({.extent = {1, 1U << 30U}}).find("allows 1x1 to"), std::string::npos);
    EXPECT_EQ(refusal({.extent = small_frame, .samples = 3}),
              "samples 3: " + name + " has " + sample_counts(gpu::test::device()));
    EXPECT_NE(refusal({.extent = small_frame, .draw = {.debug = DebugView::Depth}}).find("debug view"),
              std::string::npos);
    EXPECT_EQ(sample_counts(gpu::test::device()).substr(0, 1), "1");
}

TEST(RenderGpuRenderer, SlotsOfFramesInFlightDoNotDisturbEachOther) {
    Renderer renderer = renderer_for({.extent = small_frame, .frames_in_flight = 2});
    scene::Snapshot left = snapshot_of(small_frame), right = snapshot_of(small_frame);
    add_box(left, {-3, -1, -5}, {-1, 1, -4}, plain({1, 0, 0, 1}));
    add_box(right, {1, -1, -5}, {3, 1, -4}, plain({0, 0, 1, 1}));
    for (int i = 0; i < 9; ++i) add_box(right, {-9, -9, -20}, {-8, -8, -19}, plain(vec4(1)));
    for (int frame = 0; frame < 4; ++frame) {
        const Shot shot = shoot(renderer, frame % 2 == 0 ? left : right);
        EXPECT_EQ(shot.color.at(18, 24)[0] == 1, frame % 2 == 0);
        EXPECT_EQ(shot.color.at(46, 24)[2] == 1, frame % 2 == 1);
    }
}

TEST(RenderGpuRenderer, TheFrameNamesCameraAndLights) {
    scene::Scene scene;
    scene.entities.push_back({.name = "sun", .light = scene::Light{}});
    scene::Assets assets;
    assets.entities.resize(1);
    Renderer renderer =
        renderer_for({.extent = small_frame, .cascades = {.count = 2, .resolution = 64}}, assets, scene);
    scene::Snapshot snapshot = snapshot_of(small_frame);
    snapshot.time = 3;
    add_wall(snapshot, 4, 1, plain(vec4(1)));
    scene::LightState sun{.light = {.color = {1, 0.5F, 0.25F}, .intensity = 2, .volumetric_intensity = 4}};
    sun.direction = {0, 1, 0};
    scene::LightState lamp{.light = {.type = scene::LightType::Point}};
    snapshot.lights = {sun, lamp};
    draw(renderer, snapshot);
    const Frame frame = renderer.frame();
    EXPECT_EQ(frame.camera.depth, DepthKind::Planar);
    EXPECT_TRUE(frame.camera.is_y_down);
    EXPECT_EQ(frame.camera.near_distance, near_plane);
    EXPECT_EQ(frame.camera.projection[5], snapshot.camera.projection[1][1]);
    EXPECT_EQ(frame.time, 3);
    ASSERT_EQ(frame.lights.size(), 1U) << "directional ones alone";
    EXPECT_EQ(frame.lights[0].color, (std::array{2.0F, 1.0F, 0.5F}));
    EXPECT_EQ(frame.lights[0].volumetric_color, (std::array{1.0F, 0.5F, 0.25F}));
    EXPECT_EQ(frame.lights[0].volumetric_intensity, 4);
    EXPECT_EQ(frame.lights[0].cascade_count, 2U);
    EXPECT_TRUE(frame.lights[0].cascades.is_given());
    EXPECT_EQ(frame.lights[0].cascades.extent.width, 64U);
    EXPECT_GT(frame.lights[0].splits[1], frame.lights[0].splits[0]);
    EXPECT_EQ(frame.color.extent.width, small_frame.width);
}

}  // namespace
}  // namespace darkroom::render
