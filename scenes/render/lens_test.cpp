// SPDX-License-Identifier: MIT
// Scenes seen through a lens: how large what is out of focus gets, and what stays as it is.

#include "render/lens.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D lens_extent{96, 64};
/// A lens as large as a table, so that circles are some pixels of a small picture wide.
constexpr LensDesc wide_lens{.f_stop = 0.5F, .focus_distance = 4, .sensor_height = 1000};

/// A bright square of a pixel's size in the middle, and a dim wall behind it that fills the picture.
scene::Snapshot a_dot(float distance) {
    scene::Snapshot snapshot = snapshot_of(lens_extent);
    const float half = distance / 64;
    add_box(snapshot, {-half, -half, -distance - 0.01F}, {half, half, -distance}, plain({64, 32, 16, 1}));
    return snapshot;
}

struct LensSpread {
    double light = 0, across = 0, down = 0;
};
/// Of the red light: all of it, and its mean squares from the middle, pixels^2.
LensSpread spread_of(const Pixels& color) {
    LensSpread out;
    for (std::uint32_t y = 0; y < lens_extent.height; ++y)
        for (std::uint32_t x = 0; x < lens_extent.width; ++x) {
            const double light = double{color.at(x, y)[0]};
            out.light += light;
            out.across += light * std::pow(x + 0.5 - lens_extent.width / 2.0, 2);
            out.down += light * std::pow(y + 0.5 - lens_extent.height / 2.0, 2);
        }
    out.across /= out.light;
    out.down /= out.light;
    return out;
}

TEST(RenderLens, ItsRadiusIsThatOfAThinLens) {
    // 50 mm at f/2 on 24 mm, focused at 2 m: a point at 4 m is 0.3205 mm large, which as an angle at 2 m of a lens
    // that does not move is radius * 2 * |1/2 - 1/4| of 50 mm.
    mat4 projection = front_camera(lens_extent).projection;
    projection[1].y = -50.0F / 12;
    const Aperture aperture = aperture_of({.f_stop = 2}, projection, 2);
    EXPECT_EQ(aperture.focus_distance, 2);
    EXPECT_NEAR(aperture.radius * 2 * 0.25F * 50, 0.32051F, 1e-4F);
    EXPECT_EQ(aperture_of({.f_stop = 2, .focus_distance = 3}, projection, 2).focus_distance, 3);
    EXPECT_NEAR(aperture_of({.f_stop = 2}, projection, 0.01F).focus_distance, 0.0505F, 1e-6F) << "the focal length";
    EXPECT_EQ(aperture_of({}, projection, 2).radius, 0) << "a pinhole";
    EXPECT_EQ(aperture_of({.f_stop = 2}, front_camera(lens_extent, 4).projection, 2).radius, 0) << "no lens";
}

TEST(RenderLens, PlacesCoverTheApertureEvenly) {
    EXPECT_EQ(place_in_aperture(0, 1), vec2(0));
    for (const std::uint32_t count : {64U, 1024U}) {
        EXPECT_EQ(place_in_aperture(0, count), vec2(0));
        vec2 sum(0);
        double squares = 0;
        int inner = 0, right = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const vec2 place = place_in_aperture(i, count);
            ASSERT_LE(glm::length(place), 1.00001F);
            sum += place;
            squares += double{glm::dot(place, place)};
            inner += glm::length(place) < 0.5F ? 1 : 0;
            right += place.x > std::abs(place.y) ? 1 : 0;
        }
        const auto all = static_cast<double>(count);
        EXPECT_NEAR(squares / all, 0.5, 1e-5);
        EXPECT_LT(double{glm::length(sum)} / all, 0.02);
        EXPECT_NEAR(inner / all, 0.25, 1.01 / all);
        EXPECT_NEAR(right / all, 0.25, 0.04);
    }
}

TEST(RenderGpuLens, APointIsSeenAsACircleOfTheLens) {
    const RenderDesc desc{.extent = lens_extent, .positions = 256, .is_mean_weighed = false, .lens = wide_lens};
    Renderer renderer = renderer_for(desc, {}, dark_scene());
    const mat4 projection = front_camera(lens_extent).projection;
    const double infinity = double{aperture_of(wide_lens, projection, 0).radius} * lens_extent.height / 2 / 4;
    EXPECT_GT(infinity, 4);
    for (const float distance : {2.0F, 2.5F, 4.0F, 8.0F, 40.0F}) {
        const double radius = infinity * (1 - 4 / double{distance});
        const LensSpread spread = spread_of(shoot(renderer, a_dot(distance)).color);
        // Of a disc a quarter of its radius squared; of the dot and of the pixel a twelfth each, and half as much again
        // where pixels lie at the dot's edges.
        const double expected = radius * radius / 4 + 2.0 / 12;
        EXPECT_NEAR(spread.across, expected, 0.03 * expected + 0.12) << distance;
        EXPECT_NEAR(spread.down, expected, 0.03 * expected + 0.12) << distance;
        EXPECT_NEAR(spread.light, 64, 64 * 0.05) << distance;
    }
}

TEST(RenderGpuLens, WhatIsInFocusAndTheLayersStay) {
    RenderDesc desc{.extent = lens_extent, .positions = 64, .is_mean_weighed = false};
    scene::Snapshot snapshot = snapshot_of(lens_extent);
    snapshot.camera.target = {0, 0, -4};
    // Its edges lie between pixels, so that the least blur is seen beside them.
    add_wall(snapshot, 4, 1.25F, plain({2, 1, 0.5F, 1}));
    Renderer pinhole = renderer_for(desc, {}, dark_scene());
    // Where no distance is given, it is the target's.
    desc.lens = {.f_stop = 0.5F, .sensor_height = 1000};
    Renderer lens = renderer_for(desc, {}, dark_scene());
    const Shot sharp = shoot(pinhole, snapshot), seen = shoot(lens, snapshot);
    for (std::size_t i = 0; i < sharp.color.rgba.size(); ++i)
        // Edges through a pixel's places, which float rounds anew for each.
        ASSERT_NEAR(seen.color.rgba[i], sharp.color.rgba[i], 2.0F / 16) << i;
    snapshot.camera.target = {0, 0, -2};
    const Shot blurred = shoot(lens, snapshot);
    EXPECT_NE(blurred.color.rgba, seen.color.rgba);
    EXPECT_EQ(blurred.depth.rgba, sharp.depth.rgba);
    EXPECT_EQ(blurred.normals.rgba, sharp.normals.rgba);
    EXPECT_EQ(blurred.velocity.rgba, sharp.velocity.rgba);
}

// What a pinhole sees nothing of lies in the circle of what is far beside its picture.
TEST(RenderGpuLens, ItSeesWhatLiesBesideThePicture) {
    scene::Snapshot snapshot = snapshot_of(lens_extent);
    add_box(snapshot, {1.6F, -1, -1.1F}, {3, 1, -1}, plain({4, 4, 4, 1}));
    Renderer pinhole_renderer = renderer_for({.extent = lens_extent}, {}, dark_scene());
    const Pixels pinhole = shoot(pinhole_renderer, snapshot).color;
    Renderer lens = renderer_for({.extent = lens_extent, .positions = 64, .lens = wide_lens}, {}, dark_scene());
    EXPECT_EQ(pinhole.at(lens_extent.width - 2, 32)[0], 0);
    EXPECT_GT(shoot(lens, snapshot).color.at(lens_extent.width - 2, 32)[0], 0.1F);
}

TEST(RenderGpuLens, OnePlaceIsRefused) {
    const auto made = Renderer::create(gpu::test::device(), {}, {}, {.extent = lens_extent, .lens = {.f_stop = 2}});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().text, "lens at f/2: seen from one place; positions in a pixel: [2, 1024] are allowed");
}

}  // namespace
}  // namespace darkroom::render
