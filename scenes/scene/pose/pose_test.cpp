// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

namespace {

constexpr float tolerance = 1e-6F;

void expect_place(vec3 actual, vec3 expected, float allowed = tolerance) {
    EXPECT_NEAR(actual.x, expected.x, allowed);
    EXPECT_NEAR(actual.y, expected.y, allowed);
    EXPECT_NEAR(actual.z, expected.z, allowed);
}

vec3 origin_of(const mat4& matrix) { return vec3(matrix[3]); }

/// One node, moved by one channel over `duration` seconds.
Model moved(AnimationChannel channel, float duration) {
    Model model;
    model.nodes.resize(1);
    model.animations = {{.name = "move", .channels = {std::move(channel)}, .duration = duration}};
    return model;
}

AnimationChannel translation(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    return {.property = AnimatedProperty::Translation,
            .interpolation = interpolation,
            .times = std::move(times),
            .values = std::move(values),
            .width = 3};
}

quat about_y(float angle) { return glm::angleAxis(angle, vec3(0, 1, 0)); }

}  // namespace

TEST(ScenePose, NodesStandInTheirParents) {
    Model model;
    model.nodes.resize(3);
    model.nodes[0].transform = {.position = {1, 2, 3}, .rotation = about_y(glm::half_pi<float>()), .scale = vec3(2)};
    model.nodes[1] = {.parent = 0, .transform = {.position = {1, 0, 0}}};
    model.nodes[2] = {.parent = 1, .matrix = glm::translate(mat4(1), vec3(0, 1, 0))};
    const Pose at_rest = pose(model, no_index, 0);
    expect_place(origin_of(at_rest.nodes[1]), {1, 2, 1});  // x turns to -z, twice as far
    expect_place(origin_of(at_rest.nodes[2]), {1, 4, 1});
}

TEST(ScenePose, StepsHoldTheKeyBefore) {
    const Model model = moved(translation(Interpolation::Step, {0, 1, 2}, {0, 0, 0, 5, 0, 0, 9, 0, 0}), 2);
    expect_place(origin_of(pose(model, 0, 0.99).nodes[0]), {0, 0, 0});
    expect_place(origin_of(pose(model, 0, 1).nodes[0]), {5, 0, 0});
    expect_place(origin_of(pose(model, 0, 1.99).nodes[0]), {5, 0, 0});
}

TEST(ScenePose, LinearKeysStandStillOutsideAndLoop) {
    const Model model = moved(translation(Interpolation::Linear, {1, 3}, {0, 0, 0, 4, 8, -4}), 4);
    expect_place(origin_of(pose(model, 0, 0.5).nodes[0]), {0, 0, 0});
    expect_place(origin_of(pose(model, 0, 1.5).nodes[0]), {1, 2, -1});
    expect_place(origin_of(pose(model, 0, 3.5).nodes[0]), {4, 8, -4});
    expect_place(origin_of(pose(model, 0, 5.5).nodes[0]), {1, 2, -1});
    expect_place(origin_of(pose(model, 0, -2.5).nodes[0]), {1, 2, -1});
    expect_place(origin_of(pose(model, no_index, 1.5).nodes[0]), {0, 0, 0});
}

// Over 2 seconds from 1 (leaving with slope 3) to 5 (arriving with slope -1), worked out by hand from glTF 2.0,
// appendix C.5: at t = 1/4 it is 0.84375 * 1 + 2 * 0.140625 * 3 + 0.15625 * 5 + 2 * -0.046875 * -1 = 2.5625, at t = 1/2
// it is 0.5 * 1 + 2 * 0.125 * 3 + 0.5 * 5 + 2 * -0.125 * -1 = 4.
TEST(ScenePose, CubicSplinesUseTangentsTimesSeconds) {
    const Model model = moved(
        translation(Interpolation::CubicSpline, {1, 3}, {7, 0, 0, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 7, 0, 0}), 3);
    expect_place(origin_of(pose(model, 0, 0.5).nodes[0]), {1, 0, 0});
    expect_place(origin_of(pose(model, 0, 1.5).nodes[0]), {2.5625F, 0, 0});
    expect_place(origin_of(pose(model, 0, 2).nodes[0]), {4, 0, 0});
}

TEST(ScenePose, RotationsTakeTheShorterArcAtEvenSpeed) {
    const quat from = about_y(0), to = -about_y(glm::radians(80.0F));  // the same turn, the other sign
    AnimationChannel channel{.property = AnimatedProperty::Rotation,
                             .times = {0, 1},
                             .values = {from.x, from.y, from.z, from.w, to.x, to.y, to.z, to.w},
                             .width = 4};
    const Model model = moved(channel, 1);
    const vec3 turned_x = vec3(pose(model, 0, 0.25).nodes[0][0]);
    expect_place(turned_x, {std::cos(glm::radians(20.0F)), 0, -std::sin(glm::radians(20.0F))});
}

TEST(ScenePose, SplinedRotationsStayOfUnitLength) {
    const quat to = about_y(glm::half_pi<float>());
    AnimationChannel channel{
        .property = AnimatedProperty::Rotation,
        .interpolation = Interpolation::CubicSpline,
        .times = {0, 1},
        .values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, to.x, to.y, to.z, to.w, 0, 0, 0, 0},
        .width = 4};
    const mat4 half = pose(moved(channel, 1), 0, 0.5).nodes[0];
    EXPECT_NEAR(glm::length(vec3(half[0])), 1, tolerance);
    expect_place(vec3(half[0]), {std::sqrt(0.5F), 0, -std::sqrt(0.5F)});
}

TEST(ScenePose, WeightsComeFromMeshNodeAndClip) {
    Model model;
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(1);
    model.meshes[0].primitives[0].targets.resize(3);
    model.meshes[0].weights = {0.5F};
    model.nodes = {{.mesh = 0}, {.mesh = 0, .weights = {0.1F, 0.2F, 0.3F}}};
    model.animations = {{.channels = {{.node = 1,
                                       .property = AnimatedProperty::Weights,
                                       .times = {0, 2},
                                       .values = {0, 0, 0, 1, 2, 3},
                                       .width = 3}},
                         .duration = 2}};
    EXPECT_EQ(pose(model, no_index, 0).weights[0], (std::vector<float>{0.5F, 0, 0}));
    EXPECT_EQ(pose(model, no_index, 0).weights[1], (std::vector<float>{0.1F, 0.2F, 0.3F}));
    EXPECT_EQ(pose(model, 0, 1).weights[1], (std::vector<float>{0.5F, 1, 1.5F}));
}

TEST(ScenePose, AnEmptyOrShortChannelIsPassedOver) {
    const Model model = moved(translation(Interpolation::Linear, {0, 1}, {1, 2, 3}), 1);
    expect_place(origin_of(pose(model, 0, 0.5).nodes[0]), {0, 0, 0});
}

// A vertex at (2, 0, 0), half on a joint at (1, 0, 0) that turns a quarter about z, half on one that moves by (0, 0,
// 4).
TEST(SceneSkinning, BlendsJointsByWeight) {
    Model model;
    model.nodes.resize(2);
    model.nodes[0].transform = {.position = {1, 0, 0},
                                .rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1))};
    model.nodes[1].transform.position = {0, 0, 4};
    model.skins = {{.joints = {0, 1}, .inverse_bind = {glm::translate(mat4(1), vec3(-1, 0, 0)), mat4(1)}}};
    const Pose at_rest = pose(model, no_index, 0);
    Primitive primitive;
    primitive.vertices.resize(2);
    primitive.vertices[0].position = primitive.vertices[1].position = {2, 0, 0};
    primitive.skin = {{.joints = {0, 1, 0, 0}, .weights = {0.5F, 0.5F, 0, 0}},
                      {.joints = {0, 0, 0, 0}, .weights = {1, 0, 0, 0}}};
    const mat4 ignored = glm::translate(mat4(1), vec3(100, 0, 0));
    const std::vector<vec3> points = deform(primitive, ignored, at_rest.joints[0], {});
    expect_place(points[0], {1.5F, 0.5F, 2});
    expect_place(points[1], {1, 1, 0});
}

TEST(SceneSkinning, MorphsBeforeItSkins) {
    Primitive primitive;
    primitive.vertices.resize(1);
    primitive.vertices[0].position = {1, 0, 0};
    primitive.targets = {{.positions = {vec3(0, 1, 0)}}, {.positions = {vec3(0, 0, 8)}}};
    const std::array<float, 2> weights{2, 0.25F};
    const mat4 doubled = glm::scale(mat4(1), vec3(2));
    expect_place(deform(primitive, doubled, {}, weights)[0], {2, 4, 4});
    primitive.skin = {{.joints = {0, 0, 0, 0}, .weights = {1, 0, 0, 0}}};
    const std::array<mat4, 1> joints{glm::translate(mat4(1), vec3(10, 0, 0))};
    expect_place(deform(primitive, doubled, joints, weights)[0], {11, 2, 2});
}

}  // namespace darkroom::scene
