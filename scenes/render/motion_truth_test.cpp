// SPDX-License-Identifier: MIT
// Each pixel's motion vector against where the point that it shows was a frame before, worked out from its depth, the
// matrices and what kind of thing it is, by nothing that the shaders share.

#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/temporal_check.hpp>
#include <map>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr VkExtent2D motion_extent{97, 64};
constexpr FrameJitter off_centre{.now = {0.375F, -0.25F}, .before = {-0.4F, 0.1F}};

// Colours by which pixels are told apart.
constexpr float wall_red = 1, first_red = 2, second_red = 3, figure_red = 4, sprite_red = 5;

/// A quad of a model, whose vertices are moved by two joints, the same weights everywhere: an affine map.
constexpr vec4 skin_weights(0.75F, 0.25F, 0, 0);
scene::Assets figure() {
    scene::Primitive quad;
    for (const vec2& corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
        quad.vertices.push_back({.position = vec3(corner, 0), .normal = vec3(0, 0, 1)});
        quad.skin.push_back({.joints = {0, 1, 0, 0}, .weights = skin_weights});
    }
    quad.indices = {0, 1, 2, 0, 2, 3};
    scene::Assets assets;
    assets.models.resize(1);
    assets.models[0].meshes.push_back({.primitives = {quad}});
    return assets;
}

mat4 placed(vec3 position, float degrees, vec3 axis, float scale) {
    return glm::translate(mat4(1), position) * glm::rotate(mat4(1), glm::radians(degrees), axis) *
           glm::scale(mat4(1), vec3(scale)) * glm::translate(mat4(1), vec3(-0.5F));
}

/// A wall that stands, two boxes of one call that turn each in its own way, a skinned quad, a sprite, and sky; the
/// camera walks and turns, and its lens zooms.
scene::Snapshot moving_scene() {
    scene::Snapshot snapshot = snapshot_of(motion_extent);
    scene::CameraState& camera = snapshot.camera;
    camera.view = glm::lookAt(vec3(0.2F, 0.3F, 0), vec3(0, 0.1F, -8), vec3(0, 1, 0));
    camera.previous_view = glm::lookAt(vec3(0.35F, 0.2F, 0.3F), vec3(0.5F, -0.1F, -8), vec3(0.05F, 1, 0));
    camera.previous_projection[0][0] *= 1.04F;
    camera.previous_projection[1][1] *= 1.04F;
    const auto add = [&](float red) -> scene::Instance& {
        snapshot.materials.push_back(plain({red, 0, 0, 1}));
        scene::Instance& added = snapshot.instances.emplace_back();
        added.material = static_cast<std::uint32_t>(snapshot.materials.size() - 1);
        added.bounds = {vec3(-50), vec3(50)};
        return added;
    };
    snapshot.instances.reserve(4);
    scene::Instance& wall = add(wall_red);
    wall.world = wall.previous_world = glm::scale(glm::translate(mat4(1), {-12, -6, -21}), {19, 9, 1});
    scene::Instance& first = add(first_red);
    first.world = placed({-3, 1, -7}, 30, {0, 1, 0}, 2.4F);
    first.previous_world = placed({-3.3F, 1.2F, -7.4F}, 22, {0, 1, 0.1F}, 2.4F);
    scene::Instance& second = add(second_red);
    second.world = placed({3, -1, -6}, 70, {1, 1, 0}, 1.8F);
    second.previous_world = placed({2.6F, -1, -6}, 81, {1, 1, 0}, 1.9F);
    scene::Instance& skinned = add(figure_red);
    skinned.mesh = {0, 0, 0};
    skinned.first_joint = 0;
    skinned.joint_count = 2;
    snapshot.materials[skinned.material].surface.is_double_sided = true;
    snapshot.joints = {placed({1, 1.6F, -5}, 20, {0, 1, 0}, 1), placed({1.4F, 1.3F, -5.5F}, -15, {1, 0, 0}, 1)};
    snapshot.previous_joints = {placed({1.1F, 1.5F, -5}, 27, {0, 1, 0}, 1),
                                placed({1.2F, 1.6F, -5.2F}, -30, {1, 0, 0}, 1)};
    snapshot.sprites = {{.position = {-1, -3.4F, -6},
                         .previous_position = {-1.2F, -3.1F, -5.8F},
                         .size = {2, 2.5F},
                         .anchor_y = 0,
                         .intensity = sprite_red}};
    return snapshot;
}

/// The same with a camera alone that moves.
scene::Snapshot standing(scene::Snapshot snapshot) {
    for (scene::Instance& instance : snapshot.instances) instance.previous_world = instance.world;
    snapshot.previous_joints = snapshot.joints;
    snapshot.sprites[0].previous_position = snapshot.sprites[0].position;
    return snapshot;
}

/// What is known of the scene, in double precision.
class Truth {
  public:
    Truth(const scene::Snapshot& snapshot, const FrameJitter& jitter)
        : snapshot_(snapshot), jitter_(jitter.now[0], jitter.now[1]) {}

    /// Of the pixel's centre, pixels, y down.
    [[nodiscard]] dvec2 motion(std::uint32_t x, std::uint32_t y, double depth, float red) const {
        const scene::CameraState& camera = snapshot_.camera;
        const dvec2 seen = dvec2(x + 0.5, y + 0.5) - jitter_;
        const dvec2 clip = seen / dvec2(motion_extent.width, motion_extent.height) * 2.0 - 1.0;
        const dmat4 projection(camera.projection);
        const dvec3 ray((clip.x + projection[2][0]) / projection[0][0], (clip.y + projection[2][1]) / projection[1][1],
                        -1);
        const dmat4 to_world = glm::inverse(dmat4(camera.view));
        // Sky is a direction.
        const bool is_sky = depth > 1e9;
        const dvec4 now = to_world * dvec4(is_sky ? ray : ray * depth, is_sky ? 0 : 1);
        const dvec4 before = dmat4(camera.previous_projection) * dmat4(camera.previous_view) * previous(now, red);
        return (dvec2(before) / before.w * 0.5 + 0.5) * dvec2(motion_extent.width, motion_extent.height) - seen;
    }

  private:
    [[nodiscard]] dvec4 previous(const dvec4& now, float red) const {
        const auto moved = [&](const mat4& world, const mat4& previous_world) {
            return dmat4(previous_world) * glm::inverse(dmat4(world)) * now;
        };
        if (red == first_red || red == second_red) {
            const scene::Instance& box = snapshot_.instances[red == first_red ? 1 : 2];
            return moved(box.world, box.previous_world);
        }
        if (red == figure_red) {
            const auto& [a, b] = std::pair(skin_weights.x, skin_weights.y);
            return moved(a * snapshot_.joints[0] + b * snapshot_.joints[1],
                         a * snapshot_.previous_joints[0] + b * snapshot_.previous_joints[1]);
        }
        if (red != sprite_red) return now;
        // It faces either camera.
        const scene::SpriteState& sprite = snapshot_.sprites[0];
        const dmat4 axes = glm::transpose(dmat4(snapshot_.camera.view)),
                    previous_axes = glm::transpose(dmat4(snapshot_.camera.previous_view));
        const dvec3 from_anchor = dvec3(now) - dvec3(sprite.position);
        return {dvec3(sprite.previous_position) + dvec3(previous_axes[0]) * glm::dot(from_anchor, dvec3(axes[0])) +
                    dvec3(previous_axes[1]) * glm::dot(from_anchor, dvec3(axes[1])),
                1};
    }

    const scene::Snapshot& snapshot_;
    dvec2 jitter_;
};

/// Half floats of motion, and depth where it was drawn from.
double tolerance(const dvec2& motion) { return 0.01 + glm::length(motion) / 1024; }

Renderer motion_renderer() { return renderer_for({.extent = motion_extent}, figure(), dark_scene()); }

TEST(RenderGpuMotion, EachPixelCameFromWhereItsVectorLeads) {
    Renderer renderer = motion_renderer();
    const scene::Snapshot snapshot = moving_scene();
    for (const FrameJitter& jitter : {FrameJitter{}, off_centre}) {
        const Truth truth(snapshot, jitter);
        const Shot shot = shoot(renderer, snapshot, jitter);
        std::map<float, int> seen;
        std::map<float, double> moved;  ///< pixels, all together
        for (std::uint32_t y = 0; y < motion_extent.height; ++y)
            for (std::uint32_t x = 0; x < motion_extent.width; ++x) {
                const float red = std::nearbyint(shot.color.at(x, y)[0]);  // halves of what was interpolated
                const dvec2 expected = truth.motion(x, y, double{shot.depth.at(x, y)[0]}, red);
                const auto found = shot.velocity.at(x, y);
                ASSERT_NEAR(found[0], expected.x, tolerance(expected)) << x << ", " << y << ": " << red;
                ASSERT_NEAR(found[1], expected.y, tolerance(expected)) << x << ", " << y << ": " << red;
                moved[red] += glm::length(expected);
                ++seen[red];
            }
        EXPECT_EQ(seen.size(), 6U);
        for (const auto& [red, pixels] : seen) {
            EXPECT_GT(pixels, 60) << red;
            EXPECT_GT(moved[red] / pixels, 0.5) << red << ": no vector is right by being 0";
        }
    }
}

// What is told to hosts about theirs is true of ours. Before the sky, which the check leaves out, most must stand.
TEST(RenderGpuMotion, TheCheckOfHostsFindsNoMistake) {
    Renderer renderer = motion_renderer();
    const Shot shot = shoot(renderer, standing(moving_scene()), off_centre);
    std::vector<float> depth, velocity;
    for (std::uint32_t y = 0; y < motion_extent.height; ++y)
        for (std::uint32_t x = 0; x < motion_extent.width; ++x) {
            depth.push_back(shot.depth.at(x, y)[0]);
            velocity.insert(velocity.end(), {shot.velocity.at(x, y)[0], shot.velocity.at(x, y)[1]});
        }
    TemporalFrame frame{
        .camera = renderer.frame().camera, .extent = motion_extent, .depth = depth, .velocity = velocity};
    for (const std::string& mistake : check_temporal(frame)) ADD_FAILURE() << mistake;
    frame.camera.velocity.has_jitter = true;
    const std::vector<std::string> found = check_temporal(frame);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0], "velocity: holds no jitter, and camera.velocity.has_jitter says that it does");
}

// They are blended into what lies behind, which stays what depth and motion tell of.
TEST(RenderGpuMotion, ParticlesLeaveTheMotionOfWhatLiesBehind) {
    Renderer renderer = motion_renderer();
    scene::Snapshot snapshot = moving_scene();
    const Shot without = shoot(renderer, snapshot, off_centre);
    snapshot.emitters = {
        {.particles = {
             {.position = {0, 0, -3}, .previous_position = {1, 1, -3}, .size = 3, .color = {8, 8, 8, 0.5F}}}}};
    const Shot with = shoot(renderer, snapshot, off_centre);
    EXPECT_NE(with.color.rgba, without.color.rgba);
    EXPECT_EQ(with.velocity.rgba, without.velocity.rgba);
    EXPECT_EQ(with.depth.rgba, without.depth.rgba);
}

// A cut has no past: what the snapshot then says is that nothing moved, and no jitter comes in its place.
TEST(RenderGpuMotion, NothingMovesOverACut) {
    Renderer renderer = motion_renderer();
    scene::Snapshot snapshot = standing(moving_scene());
    snapshot.camera.previous_view = snapshot.camera.view;
    snapshot.camera.previous_projection = snapshot.camera.projection;
    const Shot shot = shoot(renderer, snapshot, off_centre);
    for (std::uint32_t y = 0; y < motion_extent.height; ++y)
        for (std::uint32_t x = 0; x < motion_extent.width; ++x)
            for (std::size_t axis = 0; axis < 2; ++axis) ASSERT_NEAR(shot.velocity.at(x, y)[axis], 0, 1e-4F);
}

}  // namespace
}  // namespace darkroom::render
