// SPDX-License-Identifier: MIT
// The colour of a frame before anything transparent was drawn, beside the finished one.

#include <gtest/gtest.h>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D transparency_extent{64, 48};

scene::Snapshot opaque_scene() {
    scene::Snapshot snapshot = snapshot_of(transparency_extent);
    add_wall(snapshot, 6, 3, plain({2, 1, 0.5F, 1}));
    snapshot.sprites = {{.position = {-2, -1, -4}, .size = {1, 2}, .anchor_y = 0, .intensity = 3}};
    return snapshot;
}

/// With a pane before half of the wall, and a puff over sprite and sky.
scene::Snapshot whole_scene() {
    scene::Snapshot snapshot = opaque_scene();
    scene::SnapshotMaterial glass = plain({0, 4, 0, 1}, scene::SurfaceBlend::Alpha);
    glass.opacity = 0.5F;
    add_box(snapshot, {0, -5, -5.1F}, {5, 5, -5}, glass);
    snapshot.emitters = {{.particles = {{.position = {-2, 1, -3}, .size = 2, .color = {8, 8, 8, 0.5F}}}}};
    return snapshot;
}

TEST(RenderGpuTransparency, IsThePictureWithoutWhatIsBlended) {
    Renderer with = renderer_for({.extent = transparency_extent, .has_transparency = true}),
             without = renderer_for({.extent = transparency_extent});
    const scene::Snapshot whole = whole_scene();
    const Pixels opaque = shoot(without, opaque_scene()).color;
    const Shot plain_shot = shoot(without, whole);
    EXPECT_FALSE(without.frame().transparency.is_given());
    for (int i = 0; i < 2; ++i) {
        const Shot shot = shoot(with, whole);
        EXPECT_EQ(shot.color.rgba, plain_shot.color.rgba) << "nothing else changes";
        EXPECT_EQ(shot.depth.rgba, plain_shot.depth.rgba);
        EXPECT_EQ(shot.normals.rgba, plain_shot.normals.rgba);
        EXPECT_EQ(shot.velocity.rgba, plain_shot.velocity.rgba);
        EXPECT_EQ(download(with.frame().transparency).rgba, opaque.rgba);
        must(with.resize(transparency_extent));
    }
    EXPECT_NE(opaque.at(48, 24), plain_shot.color.at(48, 24)) << "the pane";
    EXPECT_NE(opaque.at(16, 16), plain_shot.color.at(16, 16)) << "the puff";
}

// Nor does a driver forget how attachments are blended, where shadows are drawn first, without colours.
TEST(RenderGpuTransparency, LeavesNormalsAndVelocityAloneBehindShadows) {
    const auto lit = [](scene::Snapshot snapshot) {
        scene::LightState& sun = snapshot.lights.emplace_back();
        sun.direction = sun.light.direction = vec3(0, 0.6F, 0.8F);
        return snapshot;
    };
    Renderer renderer = renderer_for({.extent = transparency_extent});
    const Shot opaque = shoot(renderer, lit(opaque_scene()));
    const Shot whole = shoot(renderer, lit(whole_scene()));
    EXPECT_EQ(whole.normals.rgba, opaque.normals.rgba);
    EXPECT_EQ(whole.velocity.rgba, opaque.velocity.rgba);
    EXPECT_NE(whole.color.rgba, opaque.color.rgba);
}

TEST(RenderGpuTransparency, IsOfOneSampleAndPositionOfLinearLight) {
    for (const RenderDesc& desc :
         {RenderDesc{.extent = transparency_extent, .positions = 2, .has_transparency = true},
          RenderDesc{.extent = transparency_extent, .output = Output::Display, .has_transparency = true}}) {
        const Result<Renderer> made = Renderer::create(gpu::test::device(), {}, {}, desc);
        ASSERT_FALSE(made);
        EXPECT_TRUE(made.error().text.starts_with("colour before transparency: with 1 samples, ")) << made.error().text;
        EXPECT_TRUE(made.error().text.ends_with("allowed is 1, 1 and hdr")) << made.error().text;
    }
}

}  // namespace
}  // namespace darkroom::render
