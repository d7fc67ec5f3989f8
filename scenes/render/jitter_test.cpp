// SPDX-License-Identifier: MIT
// Pictures that are moved by a part of a pixel, and textures that are read as for a larger one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/composer.hpp>
#include <vector>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D jitter_extent{64, 48};

scene::Snapshot boxes() {
    scene::Snapshot snapshot = snapshot_of(jitter_extent);
    snapshot.camera.projection[2] += vec4(0.1F, -0.05F, 0, 0);
    snapshot.camera.previous_projection = snapshot.camera.projection;
    add_wall(snapshot, 4, 1.3F, plain({2, 1, 0.5F, 1}));
    add_box(snapshot, {1, -1, -7}, {3, 2, -6}, plain({0.25F, 3, 1, 1}));
    return snapshot;
}

TEST(RenderGpuJitter, MovesThePictureRightAndDown) {
    Renderer renderer = renderer_for({.extent = jitter_extent}, {}, dark_scene());
    const scene::Snapshot snapshot = boxes();
    const Shot still = shoot(renderer, snapshot), moved = shoot(renderer, snapshot, {.now = {3, 2}});
    for (std::uint32_t y = 2; y < jitter_extent.height; ++y)
        for (std::uint32_t x = 3; x < jitter_extent.width; ++x) {
            EXPECT_EQ(moved.color.at(x, y), still.color.at(x - 3, y - 2)) << x << ", " << y;
            const float depth = still.depth.at(x - 3, y - 2)[0];
            EXPECT_NEAR(moved.depth.at(x, y)[0], depth, depth * 1e-4F) << x << ", " << y;
        }
}

// The mean of many places is that of a picture drawn from many places.
TEST(RenderGpuJitter, PlacesAddUpToThePixel) {
    Renderer renderer = renderer_for({.extent = jitter_extent}, {}, dark_scene());
    const scene::Snapshot snapshot = boxes();
    constexpr std::uint64_t frames = 64;
    std::vector<double> sum(jitter_extent.width * jitter_extent.height);
    for (std::uint64_t i = 0; i < frames; ++i) {
        const Pixels color = shoot(renderer, snapshot, {.now = Composer::jitter(i, 3)}).color;
        for (std::size_t pixel = 0; pixel < sum.size(); ++pixel)
            sum[pixel] += double{color.rgba[4 * pixel]} / (1 + double{color.rgba[4 * pixel]}) / frames;
    }
    Renderer many = renderer_for({.extent = jitter_extent, .positions = 256}, {}, dark_scene());
    const Pixels truth = shoot(many, snapshot).color;
    double worst = 0;
    for (std::size_t pixel = 0; pixel < sum.size(); ++pixel)
        worst =
            std::max(worst, std::abs(sum[pixel] - double{truth.rgba[4 * pixel]} / (1 + double{truth.rgba[4 * pixel]})));
    EXPECT_LT(worst, 0.06);
}

TEST(RenderGpuJitter, TheFrameTellsOfIt) {
    Renderer renderer = renderer_for({.extent = jitter_extent}, {}, dark_scene());
    const scene::Snapshot snapshot = boxes();
    const FrameJitter jitter{.now = {0.375F, -0.25F}, .before = {-0.125F, 0.5F}};
    shoot(renderer, snapshot, jitter);
    const Camera camera = renderer.frame().camera;
    EXPECT_EQ(camera.jitter, jitter.now);
    EXPECT_EQ(camera.previous_jitter, jitter.before);
    EXPECT_EQ(camera.velocity, VelocityKind{}) << "without jitter";
    shoot(renderer, snapshot);
    const Camera still = renderer.frame().camera;
    EXPECT_EQ(still.jitter, (std::array<float, 2>{}));
    EXPECT_EQ(camera.projection, jittered(still.projection, jitter.now, jitter_extent));
    EXPECT_EQ(camera.previous_projection, jittered(still.projection, jitter.before, jitter_extent));
}

// A box that begins a quarter of a pixel outside comes into the picture.
TEST(RenderGpuJitter, WhatItBringsIntoThePictureIsDrawn) {
    Renderer renderer = renderer_for({.extent = jitter_extent}, {}, dark_scene());
    scene::Snapshot snapshot = snapshot_of(jitter_extent);
    // 6 pixels a metre at distance 4; the left edge is at -32 pixels.
    add_box(snapshot, {-9, -1, -4.001F}, {(-32 - 0.25F) / 6, 1, -4}, plain(vec4(1)));
    EXPECT_EQ(shoot(renderer, snapshot).color.at(0, 24)[0], 0);
    EXPECT_EQ(shoot(renderer, snapshot, {.now = {1, 0}}).color.at(0, 24)[0], 1);
}

/// How much a picture of a board of one-texel squares differs from its mean.
double contrast(Renderer& renderer, const scene::Snapshot& snapshot) {
    const Pixels color = shoot(renderer, snapshot).color;
    double sum = 0, squares = 0;
    for (std::uint32_t y = 16; y < 32; ++y)
        for (std::uint32_t x = 24; x < 40; ++x) {
            sum += double{color.at(x, y)[0]};
            squares += std::pow(double{color.at(x, y)[0]}, 2);
        }
    return squares / 256 - std::pow(sum / 256, 2);
}

scene::Assets board() {
    scene::Assets assets;
    assets.images.push_back({.name = "board", .width = 128, .height = 128, .rgba = {}});
    for (int i = 0; i < 128 * 128; ++i) {
        const std::uint8_t value = (i % 128 + i / 128) % 2 == 0 ? 255 : 0;
        assets.images[0].rgba.insert(assets.images[0].rgba.end(), {value, value, value, 255});
    }
    return assets;
}

TEST(RenderGpuJitter, TheMipBiasIsOfTextures) {
    const scene::Assets assets = board();
    Renderer renderer = renderer_for({.extent = jitter_extent}, assets, dark_scene());
    // Meshes and sprites: 60 pixels show 128 texels, so the level of half the size, which is grey.
    scene::Snapshot mesh = snapshot_of(jitter_extent), sprite = snapshot_of(jitter_extent);
    scene::SnapshotMaterial material = plain(vec4(1));
    material.entity_texture = 0;
    add_wall(mesh, 4, 5, material);
    sprite.sprites = {{.image = 0, .position = {0, -5, -4}, .size = {10, 10}, .anchor_y = 0}};
    for (const scene::Snapshot* const snapshot : {&mesh, &sprite}) {
        DrawOptions options = renderer.desc().draw;
        options.mip_bias = 0;
        must(renderer.set(options));
        const double plain_contrast = contrast(renderer, *snapshot);
        options.mip_bias = Composer::mip_bias(3);
        must(renderer.set(options));
        const double biased = contrast(renderer, *snapshot);
        // Between the squares' centres one tap is a mean of both: a ninth of a quarter is left.
        EXPECT_LT(plain_contrast, 2e-3);
        EXPECT_NEAR(biased, 1.0 / 36, 0.01);
    }
}

}  // namespace
}  // namespace darkroom::render
