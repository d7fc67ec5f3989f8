// SPDX-License-Identifier: MIT
#include "render/pass/sky_pass.hpp"

#include <gtest/gtest.h>

#include "render/pass/sky_pass_test_support.hpp"

namespace darkroom::render {
namespace {

using gpu::test::download;
using gpu::test::must;
using gpu::test::Pixels;
using scene::mat4;
using scene::vec2;
using scene::vec3;
using scene::vec4;

constexpr VkExtent2D extent{48, 32};

vec3 texel_direction(const Picture& sky, std::uint32_t x, std::uint32_t y) {
    return uv_to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(sky.width),
                            (static_cast<float>(y) + 0.5F) / static_cast<float>(sky.height)});
}

/// Texels hold their direction, moved to 0..2.
Picture direction_sky() {
    Picture sky(256, 128);
    for (std::uint32_t y = 0; y < sky.height; ++y)
        for (std::uint32_t x = 0; x < sky.width; ++x) {
            const vec4 value(texel_direction(sky, x, y) + 1.0F, 1);
            std::copy_n(&value.x, 4, sky.at(x, y));
        }
    return sky;
}

Picture plain_sky(vec3 light) {
    Picture sky(2, 1);
    for (std::uint32_t x = 0; x < 2; ++x) {
        const vec4 value(light, 1);
        std::copy_n(&value.x, 4, sky.at(x, 0));
    }
    return sky;
}

vec3 rgb(const Pixels& pixels, std::uint32_t x, std::uint32_t y) {
    const auto [r, g, b, a] = pixels.at(x, y);
    return {r, g, b};
}

/// What a camera sees at the centre of a pixel, from its matrices alone.
vec3 seen_direction(const scene::CameraState& camera, std::uint32_t x, std::uint32_t y) {
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(camera.projection) * glm::dmat4(camera.view));
    const glm::dvec2 place((x + 0.5) / extent.width * 2 - 1, (y + 0.5) / extent.height * 2 - 1);
    const auto point = [&](double depth) {
        const glm::dvec4 at = inverse * glm::dvec4(place, depth, 1);
        return glm::dvec3(at) / at.w;
    };
    return glm::normalize(point(0.2) - point(0.9));
}

TEST(RenderGpuSky, EveryPixelShowsTheSkyInItsDirection) {
    test::Stage stage(extent, direction_sky());
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    const mat4 wide = test::perspective(70, stage.aspect());
    mat4 off_center = wide;
    off_center[2][0] = 0.3F;
    off_center[2][1] = -0.2F;
    const std::array cameras{test::camera({0, 0, 0}, {0, 0, -1}, wide), test::camera({0, 0, 0}, {0, 0, 1}, wide),
                             test::camera({900, -20, 3000}, {901, -19, 3000.5F}, wide),
                             test::camera({0, 5, 0}, {0, 0, 0}, wide, {0, 0, -1}),
                             test::camera({1, 2, 3}, {-4, 2.5F, 1}, off_center)};
    for (const scene::CameraState& camera : cameras) {
        stage.look(camera);
        stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
        const Pixels pixels = download(stage.context, stage.color);
        for (std::uint32_t y = 0; y < extent.height; y += 5)
            for (std::uint32_t x = 0; x < extent.width; x += 5) {
                const vec3 expected = seen_direction(camera, x, y), found = rgb(pixels, x, y) - 1.0F;
                // Half a texel of the sky, where its columns meet at a pole a few.
                EXPECT_LT(glm::distance(found, expected), 0.004F)
                    << x << ", " << y << " from " << camera.position.x << " " << camera.position.y;
                EXPECT_EQ(pixels.at(x, y)[3], 1);
            }
    }
}

TEST(RenderGpuSky, AnOrthographicCameraSeesOneDirection) {
    test::Stage stage(extent, direction_sky());
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 0, 0}, {1, 0.5F, -2}, test::orthographic(10, stage.aspect())));
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    const Pixels pixels = download(stage.context, stage.color);
    const vec3 expected = glm::normalize(vec3(1, 0.5F, -2));
    for (const std::uint32_t x : {0U, 20U, 47U}) EXPECT_LT(glm::distance(rgb(pixels, x, 9) - 1.0F, expected), 0.004F);
}

TEST(RenderGpuSky, LightStaysHdrAndIsMultipliedByTheIntensity) {
    test::Stage stage(extent, plain_sky({50, 0.25F, 20000}));
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 0, 0}, {1, 0, 0}, test::perspective(60, stage.aspect())));
    stage.frame.environment_settings.x = 2;
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    EXPECT_EQ(rgb(download(stage.context, stage.color), 20, 20), vec3(100, 0.5F, 40000));
}

TEST(RenderGpuSky, WhatIsNearerHidesIt) {
    test::Stage stage(extent, plain_sky({1, 1, 1}));
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 0, 0}, {1, 0, 0}, test::perspective(60, stage.aspect())));
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); }, vec4(0.5F),
                 1e-6F);
    EXPECT_EQ(rgb(download(stage.context, stage.color), 20, 20), vec3(0.5F));
    EXPECT_EQ(download(stage.context, stage.normals).at(20, 20)[0], 7);
}

TEST(RenderGpuSky, BackgroundColorWhereNoSkyboxIs) {
    test::Stage stage(extent);
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 0, 0}, {1, 0, 0}, test::perspective(60, stage.aspect())));
    stage.frame.background = {0.5F, 0.25F, 2, 0};
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    EXPECT_EQ(rgb(download(stage.context, stage.color), 3, 30), vec3(0.5F, 0.25F, 2));
    EXPECT_EQ(rgb(download(stage.context, stage.normals), 3, 30), vec3(0));
}

TEST(RenderGpuSky, FinishedPicturesAreEncoded) {
    test::Stage stage(extent, std::nullopt, {.color = VK_FORMAT_R8G8B8A8_UNORM, .has_layers = false});
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 0, 0}, {1, 0, 0}, test::perspective(60, stage.aspect())));
    stage.frame.modes = {static_cast<std::uint32_t>(Output::Display), 0, 0, 0};
    stage.frame.background = {0.214041F, 0, 8, 0};
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    const vec3 found = rgb(download(stage.context, stage.color), 3, 30);
    EXPECT_NEAR(found.r, 0.5, 1.0 / 255);
    EXPECT_EQ(found.g, 0);
    EXPECT_EQ(found.b, 1);
}

TEST(RenderGpuSky, TheAlphaLayerIsLeftAlone) {
    test::Stage stage(extent, std::nullopt, {.has_alpha_layer = true});
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(test::camera({0, 2, 0}, {1, 0, 0}, test::perspective(60, stage.aspect())));
    stage.frame.background = {1, 1, 1, 0};
    stage.render(
        [&](VkCommandBuffer commands, VkDescriptorSet set) {
            pass.record_sky(commands, set);
            pass.record_grid(commands, set);
        },
        vec4(0, 0, 0, 0.25F));
    for (const std::uint32_t y : {2U, 20U, 30U}) EXPECT_EQ(download(stage.context, stage.color).at(9, y)[3], 0.25F);
}

TEST(RenderGpuSky, VelocityIsThatOfATurningCamera) {
    const TargetFormats formats{.velocity = VK_FORMAT_R32G32_SFLOAT};
    test::Stage stage(extent, std::nullopt, formats);
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    scene::CameraState camera = test::camera({3, 1, 2}, {4, 1.5F, -5}, test::perspective(60, stage.aspect()));
    camera.previous_view = glm::lookAt(vec3(2, 8, 2), vec3(3.2F, 8.6F, -5), vec3(0, 1, 0));
    camera.previous_projection = test::perspective(50, stage.aspect());
    stage.look(camera);
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    const Pixels velocity = download(stage.context, stage.velocity);
    for (std::uint32_t y = 0; y < extent.height; y += 6)
        for (std::uint32_t x = 0; x < extent.width; x += 6) {
            const vec4 direction(seen_direction(camera, x, y), 0);
            const vec2 expected = test::project(camera.previous_projection * camera.previous_view, direction, extent) -
                                  test::project(camera.projection * camera.view, direction, extent);
            EXPECT_NEAR(velocity.at(x, y)[0], expected.x, 2e-3) << x << ", " << y;
            EXPECT_NEAR(velocity.at(x, y)[1], expected.y, 2e-3) << x << ", " << y;
            EXPECT_GT(glm::length(expected), 0.1F);
        }
}

TEST(RenderGpuSky, AWalkingCameraSeesItStandStill) {
    test::Stage stage(extent);
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    scene::CameraState camera = test::camera({3, 1, 2}, {3, 1, -5}, test::perspective(60, stage.aspect()));
    camera.previous_view = glm::lookAt(vec3(-40, 9, 2), vec3(-40, 9, -5), vec3(0, 1, 0));
    stage.look(camera);
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_sky(commands, set); });
    const auto [x, y, b, a] = download(stage.context, stage.velocity).at(5, 5);
    EXPECT_NEAR(x, 0, 1e-4);
    EXPECT_NEAR(y, 0, 1e-4);
}

/// Straight down from 10 m: 20 pixels a metre, +x to the right, +z down.
scene::CameraState from_above(float height_m) {
    return test::camera({0, 10, 0}, {0, 0, 0}, test::orthographic(height_m, 1), {0, 0, -1});
}

TEST(RenderGpuSky, GridHasALineEveryMetre) {
    test::Stage stage({64, 64});
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    scene::CameraState camera = from_above(4);
    // Lines through centres of pixels.
    camera.view = glm::translate(mat4(1), vec3(0.5F / 16, -0.5F / 16, 0)) * camera.view;
    stage.look(camera);
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_grid(commands, set); },
                 vec4(1, 1, 1, 0.75F));
    const Pixels pixels = download(stage.context, stage.color);
    for (std::uint32_t x = 0; x < 64; ++x) {
        const float expected = x % 16 == 0 ? 0.5F + 0.5F * 0.3F : 1.0F;
        EXPECT_NEAR(pixels.at(x, 5)[0], expected, 2e-3) << x;
        EXPECT_NEAR(pixels.at(5, x)[2], expected, 2e-3) << x;
        EXPECT_EQ(pixels.at(x, 5)[3], 0.75F);
    }
    EXPECT_EQ(download(stage.context, stage.normals).at(16, 5)[1], 7);
    EXPECT_EQ(download(stage.context, stage.velocity).at(16, 5)[1], 7);
}

TEST(RenderGpuSky, GridEndsAtTwentyMetres) {
    test::Stage stage({64, 64});
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    stage.look(from_above(64));
    stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) { pass.record_grid(commands, set); }, vec4(1));
    const Pixels pixels = download(stage.context, stage.color);
    const auto is_drawn = [&](std::uint32_t x, std::uint32_t y) { return pixels.at(x, y)[0] < 0.99F; };
    EXPECT_TRUE(is_drawn(12, 32) && is_drawn(51, 32) && is_drawn(32, 12) && is_drawn(32, 51));
    EXPECT_FALSE(is_drawn(11, 32) || is_drawn(52, 32) || is_drawn(32, 11) || is_drawn(32, 52));
}

/// A floor on y = 0, split into other triangles than the grid is.
void draw_floor(const test::Stage& stage, const gpu::Pipeline& pipeline, VkCommandBuffer commands) {
    const gpu::Dispatch& vk = stage.context.vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    vk.CmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof(mat4), &stage.frame.view_projection);
    vk.CmdDraw(commands, 6, 1, 0, 0);
}

gpu::PipelineDesc floor_desc(const test::Stage& stage) {
    return {.name = "floor",
            .vertex =
                "#version 460\nlayout(push_constant) uniform Push { mat4 view_projection; };\nvoid main() {\n"
                "vec2 corners[6] = vec2[](vec2(-31, -27), vec2(0, 55), vec2(33, -29), vec2(0, 55), vec2(33, -29), "
                "vec2(70, 60));\n"
                "gl_Position = view_projection * vec4(corners[gl_VertexIndex].x, 0, corners[gl_VertexIndex].y, 1);"
                "}\n",
            .fragment = "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1); }\n",
            .push_constant_size = sizeof(mat4),
            .colors = stage.formats.colors({}, TargetFormats::Layers::Kept),
            .depth = stage.formats.depth};
}

TEST(RenderGpuSky, AFloorInItsPlaneHidesTheGrid) {
    test::Stage stage({96, 64});
    const SkyPass pass = must(SkyPass::create(stage.context, stage.setup()));
    const gpu::Pipeline floor = must(gpu::Pipeline::create(stage.context, floor_desc(stage)));
    const mat4 lens = test::perspective(60, stage.aspect());
    for (const vec3& eye : {vec3(0.3F, 1.7F, -15), vec3(3, 0.2F, -9), vec3(1, 30, -5)}) {
        stage.look(test::camera(eye, {0.5F, 0, 2}, lens));
        std::array<int, 2> dark{};
        for (const bool has_floor : {false, true}) {
            stage.render(
                [&](VkCommandBuffer commands, VkDescriptorSet set) {
                    if (has_floor) draw_floor(stage, floor, commands);
                    pass.record_grid(commands, set);
                },
                vec4(1));
            const Pixels pixels = download(stage.context, stage.color);
            for (std::uint32_t y = 0; y < 64; ++y)
                for (std::uint32_t x = 0; x < 96; ++x) dark[has_floor ? 1 : 0] += pixels.at(x, y)[0] < 0.99F ? 1 : 0;
        }
        EXPECT_GT(dark[0], 200) << eye.y;
        // The floor of the test is narrower than the grid in one corner.
        EXPECT_LT(dark[1], dark[0] / 20) << eye.y;
    }
}

}  // namespace
}  // namespace darkroom::render
