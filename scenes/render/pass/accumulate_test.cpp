// SPDX-License-Identifier: MIT
#include "render/pass/accumulate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D corner_extent{64, 48};
/// Where the wall of a_corner() begins, in pixels from the top left.
constexpr float left_edge = 20.3F, top_edge = 15.8F;
constexpr float wall_light = 4;

/// A bright wall that fills the picture to the right of left_edge and below top_edge: at distance 4 there are 6 pixels
/// a metre.
scene::Snapshot a_corner() {
    scene::Snapshot snapshot = snapshot_of(corner_extent);
    scene::Instance& wall = add_box(snapshot, {(left_edge - 32) / 6, -30, -5}, {30, (24 - top_edge) / 6, -4},
                                    plain({wall_light, wall_light, wall_light, 1}));
    wall.previous_world = glm::translate(mat4(1), {0.25F, 0, 0}) * wall.world;
    return snapshot;
}

Shot shot_of(RenderDesc desc) {
    desc.extent = corner_extent;
    Renderer renderer = renderer_for(desc, {}, dark_scene());
    return shoot(renderer, a_corner());
}

/// Of a pixel's positions, those that meet the wall when its edges are moved outward by so many pixels.
std::uint32_t covered(std::uint32_t positions, std::uint32_t x, std::uint32_t y, double outward) {
    std::uint32_t count = 0;
    for (const vec2& position : positions_in_pixel(positions)) {
        const vec2 place = vec2(x, y) + 0.5F + position;
        count += place.x > left_edge - outward && place.y > top_edge - outward ? 1 : 0;
    }
    return count;
}

/// Light of a pixel, so many of whose positions meet the wall: weighed, added up, unweighed.
float light_of(std::uint32_t count, std::uint32_t positions) {
    const float mean = static_cast<float>(count) * wall_light / (1 + wall_light) / static_cast<float>(positions);
    return mean / (1 - mean);
}

TEST(RenderAccumulate, PositionsAreCentredAndShareNoRowOrColumn) {
    for (const std::uint32_t count : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 16U, 33U, 64U, 256U, 1024U}) {
        const std::vector<vec2> places = positions_in_pixel(count);
        ASSERT_EQ(places.size(), count);
        std::vector<int> rows(count), columns(count);
        vec2 sum(0);
        for (const vec2& place : places) {
            const vec2 cell = (place + 0.5F) * float(count) - 0.5F;
            ASSERT_TRUE(cell.x > -0.1F && cell.x < float(count) && cell.y > -0.1F && cell.y < float(count)) << count;
            ++columns[std::size_t(std::lround(cell.x))];
            ++rows[std::size_t(std::lround(cell.y))];
            sum += place;
            EXPECT_GE(glm::dot(place, place), glm::dot(places[0], places[0])) << count;
        }
        EXPECT_NEAR(sum.x, 0, 1e-3F) << count;
        EXPECT_NEAR(sum.y, 0, 1e-3F) << count;
        EXPECT_EQ(std::ranges::count(rows, 1), count);
        EXPECT_EQ(std::ranges::count(columns, 1), count);
        EXPECT_EQ(places[0] == vec2(0), count % 2 == 1) << count;
    }
}

TEST(RenderAccumulate, PositionsCoverThePixelEvenly) {
    std::array<int, 16> cells{};
    for (const vec2& position : positions_in_pixel(256)) {
        const vec2 place = position + 0.5F;
        ++cells[static_cast<std::size_t>(place.x * 4) + 4 * static_cast<std::size_t>(place.y * 4)];
    }
    // Random ones would stray by 8.
    for (const int count : cells) EXPECT_NEAR(count, 16, 3);
    // Edges at 45 degrees see the four one after another, too.
    std::set<int> diagonals;
    for (const vec2& place : positions_in_pixel(4)) diagonals.insert(int(std::lround(place.x * 8 + place.y * 8)));
    EXPECT_EQ(diagonals.size(), 4U);
}

TEST(RenderGpuAccumulate, EdgesAreTheMeanOfThePositions) {
    for (const std::uint32_t positions : {2U, 7U, 32U}) {
        const Shot shot = shot_of({.positions = positions});
        for (const auto& [x, y] : {std::pair(20U, 30U), {40U, 15U}, {20U, 15U}, {19U, 30U}, {40U, 14U}, {21U, 16U}}) {
            // The wall's edges are as far off as its vertices.
            const double shift = gpu::test::vertex_shift();
            const float least = light_of(covered(positions, x, y, -shift), positions);
            const float most = light_of(covered(positions, x, y, shift), positions), found = shot.color.at(x, y)[0];
            EXPECT_NEAR(found, std::clamp(found, least, most), 4e-3F) << positions << ": " << x << ' ' << y;
        }
    }
}

TEST(RenderGpuAccumulate, TheLayersAreThoseOfTheCentre) {
    const Shot one = shot_of({}), many = shot_of({.positions = 7});
    EXPECT_EQ(one.depth.rgba, many.depth.rgba);
    EXPECT_EQ(one.normals.rgba, many.normals.rgba);
    EXPECT_EQ(one.velocity.rgba, many.velocity.rgba);
    EXPECT_NE(one.color.rgba, many.color.rgba);
    // Of an even number none is the centre, and what moves does so as much beside it.
    const Shot two = shot_of({.positions = 2});
    for (int channel = 0; channel < 2; ++channel)
        EXPECT_NEAR(two.velocity.at(30, 30)[channel], one.velocity.at(30, 30)[channel], 1e-4F);
}

TEST(RenderGpuAccumulate, WhatIsOnlyDrawnOnceIsLeftAlone) {
    const Shot shot = shot_of({.positions = 1});
    EXPECT_EQ(shot.color.at(19, 30)[0], 0);
    EXPECT_EQ(shot.color.at(20, 30)[0], wall_light);
}

TEST(RenderGpuAccumulate, TwoFramesOfAStillSceneAreEqual) {
    Renderer renderer =
        renderer_for({.extent = corner_extent, .positions = 3, .frames_in_flight = 2}, {}, dark_scene());
    const scene::Snapshot snapshot = a_corner();
    const Shot first = shoot(renderer, snapshot);
    must(renderer.resize({corner_extent.width / 2, corner_extent.height / 2}));
    shoot(renderer, snapshot);
    must(renderer.resize(corner_extent));
    for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(shoot(renderer, snapshot).color.rgba, first.color.rgba);
}

TEST(RenderGpuAccumulate, SamplesOfTheRasteriserAddToThePositions) {
    if ((gpu::test::context().traits.sample_counts & VK_SAMPLE_COUNT_4_BIT) == 0)
        GTEST_SKIP() << "the device has no 4 samples";
    // Of two positions alone the coverage is a multiple of one half.
    const float found = shot_of({.samples = 4, .positions = 2}).color.at(20, 30)[0];
    const float mean = found / (1 + found) * (1 + wall_light) / wall_light;
    EXPECT_NEAR(mean, 0.7F, 0.13F);
    EXPECT_GT(std::abs(mean - 0.5F), 0.05F);
    EXPECT_GT(std::abs(mean - 1), 0.05F);
}

TEST(RenderGpuAccumulate, LightIsAPlainMeanWhereThatIsAsked) {
    const float weighed = shot_of({.positions = 16}).color.at(20, 30)[0];
    const float plain_mean = shot_of({.positions = 16, .is_mean_weighed = false}).color.at(20, 30)[0];
    const double shift = gpu::test::vertex_shift();
    const float least = static_cast<float>(covered(16, 20, 30, -shift)) / 16 * wall_light;
    const float most = static_cast<float>(covered(16, 20, 30, shift)) / 16 * wall_light;
    EXPECT_NEAR(plain_mean, std::clamp(plain_mean, least, most), 4e-3F * wall_light);
    EXPECT_GT(plain_mean, weighed * 1.1F);
}

TEST(RenderGpuAccumulate, AlphaIsAPlainMean) {
    scene::Scene scene = dark_scene();
    scene.has_alpha_layer = true;
    scene::Snapshot snapshot = a_corner();
    snapshot.materials[0].writes = scene::Writes::Alpha;
    Renderer renderer = renderer_for({.extent = corner_extent, .positions = 16}, {}, scene);
    const Pixels color = shoot(renderer, snapshot).color;
    EXPECT_EQ(color.at(40, 30)[3], 1);
    const double shift = gpu::test::vertex_shift();
    const float least = static_cast<float>(covered(16, 20, 30, -shift)) / 16;
    const float most = static_cast<float>(covered(16, 20, 30, shift)) / 16, found = color.at(20, 30)[3];
    EXPECT_NEAR(found, std::clamp(found, least, most), 1e-3F);
}

TEST(RenderGpuAccumulate, AnUnusualNumberIsRefused) {
    for (const std::uint32_t positions : {0U, 1025U}) {
        const auto made =
            Renderer::create(gpu::test::device(), {}, {}, {.extent = corner_extent, .positions = positions});
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().text, fmt::format("positions in a pixel: {}, [1, 1024] are allowed", positions));
    }
}

}  // namespace
}  // namespace darkroom::render
