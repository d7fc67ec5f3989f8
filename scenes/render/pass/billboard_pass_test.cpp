// SPDX-License-Identifier: MIT
#include "render/pass/billboard_pass.hpp"

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

using Rgba = std::array<std::uint8_t, 4>;

scene::Image image_of(std::uint32_t width, const std::vector<Rgba>& pixels) {
    scene::Image image{
        .name = "test", .width = width, .height = static_cast<std::uint32_t>(pixels.size()) / width, .rgba = {}};
    for (const Rgba& pixel : pixels) image.rgba.insert(image.rgba.end(), pixel.begin(), pixel.end());
    return image;
}

constexpr Rgba red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255}, white{255, 255, 255, 255};
enum Images : std::uint32_t { Corners, Atlas, White, JustOpaque, JustNot, Grey };

scene::Assets test_assets() {
    scene::Assets assets;
    assets.images = {image_of(2, {red, green, blue, white}),
                     image_of(4, {red, red, green, green, blue, blue, white, white}),
                     image_of(1, {white}),
                     image_of(1, {Rgba{255, 255, 255, 128}}),
                     image_of(1, {Rgba{255, 255, 255, 127}}),
                     image_of(1, {Rgba{188, 188, 188, 255}})};
    return assets;
}

/// 64 x 64 pixels of 8 x 8 m in the plane z = 0, origin in the middle.
struct Billboards {
    explicit Billboards(const TargetFormats& formats = {}) : stage({64, 64}, std::nullopt, formats) {
        snapshot.camera = test::camera({0, 0, 10}, {0, 0, 0}, test::orthographic(8, 1));
    }
    /// Sprites and then particles.
    void draw(vec4 clear = vec4(0), float clear_depth = 0, std::uint32_t slot = 0) {
        must(pass.prepare(snapshot, scene, slot));
        stage.look(snapshot.camera);
        stage.render(
            [&](VkCommandBuffer commands, VkDescriptorSet set) {
                pass.record_sprites(commands, set, slot);
                pass.record_particles(commands, set, slot);
            },
            clear, clear_depth);
    }
    [[nodiscard]] vec4 pixel(std::uint32_t x, std::uint32_t y) const {
        const auto [r, g, b, a] = download(stage.context, stage.color).at(x, y);
        return {r, g, b, a};
    }

    test::Stage stage;
    GpuScene scene = must(GpuScene::create(gpu::test::context(), test_assets()));
    BillboardPass pass = must(BillboardPass::create(gpu::test::context(), stage.setup(), scene));
    scene::Snapshot snapshot;
};

/// The pixels that are not black.
struct Bounds {
    std::uint32_t left = 999, top = 999, right = 0, bottom = 0, count = 0;
    friend bool operator==(const Bounds&, const Bounds&) = default;
};
Bounds lit(const Pixels& pixels) {
    Bounds bounds;
    for (std::uint32_t y = 0; y < pixels.height; ++y)
        for (std::uint32_t x = 0; x < pixels.width; ++x) {
            const auto [r, g, b, a] = pixels.at(x, y);
            if (r + g + b == 0) continue;
            bounds = {std::min(bounds.left, x), std::min(bounds.top, y), std::max(bounds.right, x + 1),
                      std::max(bounds.bottom, y + 1), bounds.count + 1};
        }
    return bounds;
}

void expect_color(vec4 found, vec4 expected, float tolerance = 2e-3F) {
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(found[i], expected[i],
                    (tolerance + static_cast<float>(gpu::test::filter_step())) * std::max(1.0F, expected[i]))
            << "channel " << i;
}

scene::Particle particle(vec3 position, vec4 color, float size = 4) {
    return {.position = position, .previous_position = position, .size = size, .color = color};
}

TEST(RenderGpuBillboards, SpritesHaveTheirSizeAndStandOnTheirAnchor) {
    Billboards test;
    for (const auto& [anchor, top] : {std::pair{0.0F, 8U}, {1.0F, 32U}, {0.5F, 20U}}) {
        test.snapshot.sprites = {{.size = {2, 3}, .anchor_y = anchor}};
        test.draw();
        EXPECT_EQ(lit(download(test.stage.context, test.stage.color)), (Bounds{24, top, 40, top + 24, 16 * 24}))
            << anchor;
    }
}

TEST(RenderGpuBillboards, SpritesShrinkWithDistance) {
    Billboards test;
    test.snapshot.camera = test::camera({0, 0, 10}, {0, 0, 0}, test::perspective(90, 1));
    test.snapshot.sprites = {{.position = {0, 0, 6}, .size = {2, 2}, .anchor_y = 0.5F}};
    test.draw();
    EXPECT_EQ(lit(download(test.stage.context, test.stage.color)), (Bounds{24, 24, 40, 40, 256}));
    test.snapshot.sprites[0].position.z = 2;
    test.draw();
    EXPECT_EQ(lit(download(test.stage.context, test.stage.color)), (Bounds{28, 28, 36, 36, 64}));
}

TEST(RenderGpuBillboards, SpritesFaceTheCameraFromEverySide) {
    Billboards test;
    test.snapshot.sprites = {{.position = {1, 2, 3}, .size = {2, 2}, .anchor_y = 0.5F}};
    for (const vec3& offset : {vec3(10, 0, 0), vec3(0, 0, -10), vec3(3, 9, 2), vec3(-5, -8, 1)}) {
        test.snapshot.camera = test::camera(vec3(1, 2, 3) + offset, {1, 2, 3}, test::orthographic(8, 1));
        test.draw();
        EXPECT_NEAR(lit(download(test.stage.context, test.stage.color)).count, 256, 2);
        const auto [x, y, z, w] = download(test.stage.context, test.stage.normals).at(32, 32);
        EXPECT_EQ(vec3(x, y, z), vec3(0)) << "what has a normal occludes";
    }
}

TEST(RenderGpuBillboards, TexturesAreUprightAndDecoded) {
    Billboards test;
    test.snapshot.sprites = {{.image = Corners, .size = {8, 8}, .anchor_y = 0.5F}};
    test.draw();
    expect_color(test.pixel(2, 2), {1, 0, 0, 1});
    expect_color(test.pixel(61, 2), {0, 1, 0, 1});
    expect_color(test.pixel(2, 61), {0, 0, 1, 1});
    expect_color(test.pixel(61, 61), {1, 1, 1, 1});
    test.snapshot.sprites[0].image = Grey;
    test.draw();
    expect_color(test.pixel(30, 30), {0.50289F, 0.50289F, 0.50289F, 1});
}

TEST(RenderGpuBillboards, SpritesGlowAboveOne) {
    Billboards test;
    test.snapshot.sprites = {{.image = Grey, .size = {8, 8}, .anchor_y = 0.5F, .intensity = 8}};
    test.draw();
    expect_color(test.pixel(30, 30), {8 * 0.50289F, 8 * 0.50289F, 8 * 0.50289F, 1});
}

TEST(RenderGpuBillboards, AnAtlasFrameShowsNothingOfItsNeighbours) {
    Billboards test;
    // The second frame of two columns and two rows: green alone.
    test.snapshot.sprites = {{.image = Atlas, .size = {6, 6}, .anchor_y = 0.5F, .uv = {0.5F, 0, 1, 0.5F}}};
    test.draw();
    const Pixels pixels = download(test.stage.context, test.stage.color);
    EXPECT_EQ(lit(pixels).count, 48U * 48U);
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            EXPECT_EQ(pixels.at(x, y)[0], 0) << x << ", " << y;
            EXPECT_EQ(pixels.at(x, y)[2], 0) << x << ", " << y;
        }
}

TEST(RenderGpuBillboards, AlphaBelowOneHalfIsCutOut) {
    Billboards test;
    test.snapshot.sprites = {{.image = JustNot, .size = {4, 4}}};
    test.draw();
    EXPECT_EQ(lit(download(test.stage.context, test.stage.color)).count, 0U);
    EXPECT_EQ(download(test.stage.context, test.stage.depth).at(32, 20)[0], 0);
    test.snapshot.sprites[0].image = JustOpaque;
    test.draw();
    expect_color(test.pixel(32, 20), {1, 1, 1, 1});
}

TEST(RenderGpuBillboards, SpritesHideEachOtherByDepth) {
    Billboards test;
    for (const float nearer : {1.0F, -1.0F}) {
        test.snapshot.sprites = {{.image = Corners, .size = {4, 4}, .anchor_y = 0.5F, .uv = {0, 0, 0.5F, 0.5F}},
                                 {.image = White, .position = {0, 0, nearer}, .size = {2, 2}, .anchor_y = 0.5F}};
        test.draw();
        expect_color(test.pixel(32, 32), nearer > 0 ? vec4(1) : vec4(1, 0, 0, 1));
        expect_color(test.pixel(20, 32), {1, 0, 0, 1});
        const vec4 clip = test.stage.frame.view_projection * vec4(0, 0, std::max(nearer, 0.0F), 1);
        EXPECT_NEAR(download(test.stage.context, test.stage.depth).at(32, 32)[0], clip.z, 1e-6);
    }
}

TEST(RenderGpuBillboards, VelocityIsThatOfSpriteAndCamera) {
    Billboards test({.velocity = VK_FORMAT_R32G32_SFLOAT});
    test.snapshot.camera = test::camera({0.5F, 1, 4}, {0, 0.5F, 0}, test::perspective(60, 1));
    scene::CameraState& camera = test.snapshot.camera;
    camera.projection[2][0] = 0.2F;
    camera.previous_projection[2][0] = 0.2F;
    camera.previous_view = glm::lookAt(vec3(0.9F, 1.2F, 4.5F), vec3(0.3F, 0.4F, 0), vec3(0, 1, 0));
    const scene::SpriteState sprite{
        .position = {0.2F, 0, 0}, .previous_position = {-0.1F, 0.1F, 0.4F}, .size = {2, 3}, .anchor_y = 0.25F};
    test.snapshot.sprites = {sprite};
    test.draw();
    const Pixels velocity = download(test.stage.context, test.stage.velocity);
    const mat4 now = camera.projection * camera.view, then = camera.previous_projection * camera.previous_view;
    for (const vec2& place : {vec2(-0.8F, -0.6F), vec2(0.8F, 2.0F), vec2(0, 0), vec2(-0.9F, 2.1F)}) {
        const auto corner = [&](const mat4& view, vec3 origin) {
            const mat4 to_world = glm::inverse(view);
            return vec4(origin + vec3(to_world[0]) * place.x + vec3(to_world[1]) * place.y, 1);
        };
        const vec2 at = test::project(now, corner(camera.view, sprite.position), test.stage.extent);
        const vec2 expected =
            test::project(then, corner(camera.previous_view, sprite.previous_position), test.stage.extent) - at;
        const auto found = velocity.at(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
        // Up to a pixel beside `at`, where the motion is a little other.
        EXPECT_NEAR(found[0], expected.x, 0.15) << place.x << ", " << place.y;
        EXPECT_NEAR(found[1], expected.y, 0.15) << place.x << ", " << place.y;
        EXPECT_GT(glm::length(expected), 1);
    }
}

TEST(RenderGpuBillboards, AResetCameraGivesStillSpritesNoVelocity) {
    Billboards test({.velocity = VK_FORMAT_R32G32_SFLOAT});
    for (const mat4& projection : {test::perspective(60, 1), test::orthographic(8, 1)}) {
        test.snapshot.camera = test::camera({3, 1, 4}, {0, 0.5F, 0}, projection);
        test.snapshot.sprites = {{.size = {2, 3}, .anchor_y = 0.5F}};
        test.draw();
        EXPECT_NEAR(download(test.stage.context, test.stage.velocity).at(32, 30)[0], 0, 1e-4);
        EXPECT_NEAR(download(test.stage.context, test.stage.velocity).at(32, 30)[1], 0, 1e-4);
    }
}

TEST(RenderGpuBillboards, ParticlesBlendAndStayHdr) {
    Billboards test;
    const vec4 behind(0.2F, 0.2F, 0.2F, 0.75F);
    test.snapshot.emitters = {{.image = White, .particles = {particle(vec3(0), {40, 4, 0.4F, 0.25F})}}};
    test.draw(behind);
    expect_color(test.pixel(32, 32), {10.15F, 1.15F, 0.25F, 0.75F});
    EXPECT_EQ(test.pixel(2, 2), test.pixel(60, 60));
    test.snapshot.emitters[0].blend = scene::SurfaceBlend::Additive;
    test.draw(behind);
    expect_color(test.pixel(32, 32), {10.2F, 1.2F, 0.3F, 0.75F});
    EXPECT_EQ(lit(download(test.stage.context, test.stage.color)).count, 64U * 64U);
}

TEST(RenderGpuBillboards, ParticlesWriteNeitherDepthNorLayersAndAreHidden) {
    Billboards test;
    test.snapshot.emitters = {{.image = White, .particles = {particle({0, 0, -1}, {1, 0, 0, 1})}}};
    test.draw();
    EXPECT_EQ(download(test.stage.context, test.stage.depth).at(32, 32)[0], 0);
    EXPECT_EQ(download(test.stage.context, test.stage.normals).at(32, 32)[0], 7);
    EXPECT_EQ(download(test.stage.context, test.stage.velocity).at(32, 32)[0], 7);
    test.snapshot.sprites = {{.size = {1, 1}, .anchor_y = 0.5F}};
    test.draw();
    expect_color(test.pixel(32, 32), {1, 1, 1, 1});
    expect_color(test.pixel(20, 20), {1, 0, 0, 0});
}

TEST(RenderGpuBillboards, ParticlesOfAllEmittersAreDrawnBackToFront) {
    Billboards test;
    // Depths alternate between two emitters, neither of which is in order.
    test.snapshot.emitters = {
        {.image = White, .particles = {particle({0, 0, 3}, {1, 0, 0, 0.5F}), particle({0, 0, 1}, {0, 1, 0, 0.5F})}},
        {.image = Grey, .particles = {particle({0, 0, 2}, {0, 0, 2, 0.5F}), particle({0, 0, 0}, {2, 2, 2, 0.5F})}}};
    test.draw();
    vec3 expected(0);
    const float grey = 0.50289F;
    for (const vec3& color : {vec3(2 * grey), vec3(0, 1, 0), vec3(0, 0, 2 * grey), vec3(1, 0, 0)})
        expected = expected * 0.5F + color * 0.5F;
    expect_color(test.pixel(32, 32), vec4(expected, 0));
    // The order turns with the camera.
    test.snapshot.camera = test::camera({0, 0, -10}, {0, 0, 0}, test::orthographic(8, 1));
    test.draw();
    expected = vec3(0);
    for (const vec3& color : {vec3(1, 0, 0), vec3(0, 0, 2 * grey), vec3(0, 1, 0), vec3(2 * grey)})
        expected = expected * 0.5F + color * 0.5F;
    expect_color(test.pixel(32, 32), vec4(expected, 0));
}

TEST(RenderGpuBillboards, AdditiveParticlesAreCoveredByThoseBeforeThem) {
    Billboards test;
    scene::ParticleState glow{.image = White, .blend = scene::SurfaceBlend::Additive};
    glow.particles = {particle({0, 0, -2}, {3, 0, 0, 1})};
    test.snapshot.emitters = {glow, {.image = White, .particles = {particle({0, 0, 2}, {0, 1, 0, 0.5F})}}};
    test.draw(vec4(1, 1, 1, 0));
    expect_color(test.pixel(32, 32), {2, 1, 0.5F, 0});
    test.snapshot.emitters[0].particles[0].position.z = 4;
    test.draw(vec4(1, 1, 1, 0));
    expect_color(test.pixel(32, 32), {3.5F, 1, 0.5F, 0});
}

TEST(RenderGpuBillboards, ParticlesWithoutTextureAreSoftDiscs) {
    Billboards test;
    test.snapshot.emitters = {{.particles = {particle(vec3(0), vec4(1), 8)}}};
    test.draw();
    const Pixels pixels = download(test.stage.context, test.stage.color);
    EXPECT_GT(pixels.at(32, 32)[0], 0.99F);
    for (std::uint32_t x = 32; x < 63; ++x) {
        EXPECT_GE(pixels.at(x, 32)[0], pixels.at(x + 1, 32)[0]) << x;
        EXPECT_NEAR(pixels.at(x, 32)[0], pixels.at(32, x)[0], 1e-3) << x;
        EXPECT_NEAR(pixels.at(x, 32)[0], pixels.at(63 - x, 32)[0], 1e-3) << x;
    }
    EXPECT_LT(pixels.at(63, 32)[0], 0.01F);
    EXPECT_EQ(pixels.at(4, 4)[0], 0);
    EXPECT_NEAR(lit(pixels).count, std::numbers::pi * 32 * 32, 40);
}

std::uint32_t draws = 0;
PFN_vkCmdDraw real_draw = nullptr;
void VKAPI_CALL count_draw(VkCommandBuffer commands, std::uint32_t vertices, std::uint32_t instances,
                           std::uint32_t first_vertex, std::uint32_t first_instance) {
    ++draws;
    real_draw(commands, vertices, instances, first_vertex, first_instance);
}

TEST(RenderGpuBillboards, SquaresOfOneTextureAreDrawnByOneCall) {
    Billboards test;
    scene::ParticleState sparks{.image = White, .blend = scene::SurfaceBlend::Additive};
    scene::ParticleState embers{.image = Grey, .blend = scene::SurfaceBlend::Additive};
    for (int i = 0; i < 100; ++i) {
        const float z = static_cast<float>(i) * 0.01F;
        test.snapshot.sprites.push_back({.image = i % 2 == 0 ? Corners : White, .position = {0, 0, z}});
        sparks.particles.push_back(particle({0, 0, z}, vec4(1)));
        embers.particles.push_back(particle({0, 0, z}, vec4(1)));
    }
    scene::ParticleState smoke{.image = White, .particles = sparks.particles};
    for (scene::Particle& particle : smoke.particles) particle.position.z += 2;
    test.snapshot.emitters = {sparks, embers, smoke};
    gpu::Dispatch& vk = test.stage.context.vk;
    real_draw = vk.CmdDraw;
    draws = 0;
    vk.CmdDraw = count_draw;
    test.draw();
    vk.CmdDraw = real_draw;
    EXPECT_EQ(draws, 5U);
}

TEST(RenderGpuBillboards, SlotsGrowAndKeepTheirOwnSquares) {
    Billboards test;
    test.snapshot.sprites = {{.image = Corners, .size = {8, 8}, .anchor_y = 0.5F, .uv = {0, 0, 0.5F, 0.5F}}};
    test.draw(vec4(0), 0, 0);
    test.snapshot.sprites.assign(300, {.image = White, .position = {0, 0, -1}, .size = {8, 8}, .anchor_y = 0.5F});
    test.draw(vec4(0), 0, 1);
    expect_color(test.pixel(9, 9), vec4(1));
    test.stage.render(
        [&](VkCommandBuffer commands, VkDescriptorSet set) { test.pass.record_sprites(commands, set, 0); });
    expect_color(test.pixel(9, 9), {1, 0, 0, 1});
    test.draw(vec4(0), 0, 0);
    expect_color(test.pixel(9, 9), vec4(1));
    test.snapshot.sprites.clear();
    test.draw(vec4(0.5F), 0, 0);
    expect_color(test.pixel(9, 9), vec4(0.5F));
}

TEST(RenderGpuBillboards, TheAlphaLayerIsLeftAlone) {
    Billboards test({.has_alpha_layer = true});
    test.snapshot.sprites = {{.size = {4, 4}, .anchor_y = 0.5F}};
    test.snapshot.emitters = {{.particles = {particle({0, 0, 1}, vec4(1))}}};
    test.draw(vec4(0, 0, 0, 0.25F));
    expect_color(test.pixel(32, 32), {1, 1, 1, 0.25F});
}

TEST(RenderGpuBillboards, FinishedPicturesAreEncoded) {
    Billboards test({.color = VK_FORMAT_R8G8B8A8_UNORM, .has_layers = false});
    test.stage.frame.modes = {static_cast<std::uint32_t>(Output::Display), 0, 0, 0};
    test.snapshot.sprites = {{.image = Grey, .size = {4, 4}, .anchor_y = 0.5F}};
    test.snapshot.emitters = {{.image = White, .particles = {particle({3, 0, 1}, {0.214041F, 0, 8, 0.5F}, 1.5F)}}};
    test.draw();
    expect_color(test.pixel(32, 32), {188 / 255.0F, 188 / 255.0F, 188 / 255.0F, 1}, 1.1F / 255);
    expect_color(test.pixel(56, 32), {0.25F, 0, 0.5F, 0}, 1.1F / 255);
}

}  // namespace
}  // namespace darkroom::render
