// SPDX-License-Identifier: MIT
#include "scene/walk/free_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace darkroom::scene {

namespace {

constexpr Box hall{vec3(-3, 0, -8), vec3(5, 4, 2)};

Scene seen_from(vec3 position, vec3 target, Projection projection = Projection::Perspective) {
    Scene scene;
    scene.camera = {.is_given = true, .projection = projection, .position = position, .target = target};
    return scene;
}

CameraState state_of(const Scene& scene, const SnapshotOptions& options = {}) {
    return snapshot(scene, {}, options).camera;
}

CameraState state_of(const FreeCamera& camera, float aspect = 1) {
    return state_of(seen_from({0, 0, 9}, {1, 2, 3}, camera.kind), {.aspect = aspect, .orbit = override_of(camera)});
}

/// x, y of the picture in -1..1 with y down, and depth.
vec3 projected(const CameraState& camera, vec3 point) {
    const vec4 clip = camera.projection * camera.view * vec4(point, 1);
    return vec3(clip) / clip.w;
}

void expect_near(vec3 actual, vec3 expected, float allowed) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], allowed) << "axis " << axis;
}

void expect_same_view(const CameraState& actual, const CameraState& expected, float allowed) {
    for (int column = 0; column < 4; ++column)
        expect_near(vec3(actual.view[column]), vec3(expected.view[column]), allowed);
}

}  // namespace

TEST(SceneFreeCamera, KeepsTheViewThatItIsTakenFrom) {
    for (const vec3& target : {vec3(1, 2, 3), vec3(-4, 7, 2), vec3(5, -6, 0.5F), vec3(2, 20, 4), vec3(2, -20, 4)}) {
        const CameraState before = state_of(seen_from({2, 1, 4}, target));
        const FreeCamera camera = free_camera(before);
        expect_same_view(state_of(camera), before, 2e-5F);
        expect_near(camera.target(), target, 1e-4F);
        expect_near(camera.up(), {before.view[0].y, before.view[1].y, before.view[2].y}, 1e-5F);
    }
}

TEST(SceneFreeCamera, FlyingAndOrbitingMayTakeTurns) {
    FreeCamera camera{.eye = {1, 2, 3}, .distance = 5};
    look_around(camera, 30, 10);
    EXPECT_EQ(camera.eye, vec3(1, 2, 3));
    const vec3 target = camera.target();
    orbit(camera, -75, 25);
    expect_near(camera.target(), target, 1e-5F);
    EXPECT_NEAR(glm::length(camera.eye - target), 5, 1e-5F);
    EXPECT_EQ(camera.yaw, -45);
    EXPECT_EQ(camera.pitch, 35);
    const vec3 eye = camera.eye;
    fly(camera, {0, 0, 2});
    expect_near(camera.eye, eye + 2.0F * camera.forward(), 1e-5F);
    fly(camera, {1, 3, 0});
    expect_near(camera.eye, eye + 2.0F * camera.forward() + camera.right() + vec3(0, 3, 0), 1e-5F);
}

TEST(SceneFreeCamera, TurnsNeitherRollNorOverturn) {
    FreeCamera camera;
    look_around(camera, 350, 200);
    EXPECT_EQ(camera.yaw, -10);
    EXPECT_EQ(camera.pitch, 90);
    EXPECT_LT(camera.up().z, -0.9F) << "-z is at the top, but for 10 degrees";
    EXPECT_NEAR(state_of(camera).view[2].y, camera.up().z, 1e-6F);
    orbit(camera, 0, -500);
    EXPECT_EQ(camera.pitch, -90);
}

TEST(SceneFreeCamera, APannedPictureFollowsThePointer) {
    for (const Projection kind : {Projection::Perspective, Projection::Orthographic}) {
        FreeCamera camera{.eye = {1, 2, 3}, .yaw = 20, .pitch = 30, .distance = 4, .kind = kind};
        const vec3 point = camera.target();
        pan(camera, {0.125F, -0.25F});
        expect_near(vec3(vec2(projected(state_of(camera), point)), 0), {0.25F, -0.5F, 0}, 1e-5F);
    }
}

TEST(SceneFreeCamera, DollyKeepsTheTarget) {
    FreeCamera camera{.eye = {1, 2, 3}, .yaw = 20, .pitch = 30, .distance = 4};
    const vec3 target = camera.target();
    dolly(camera, 0.5F);
    EXPECT_EQ(camera.distance, 2);
    expect_near(camera.target(), target, 1e-5F);
    dolly(camera, 0);
    EXPECT_GT(camera.distance, 0);
    dolly(camera, 1e30F);
    EXPECT_EQ(camera.distance, 1e6F);
}

TEST(SceneFreeCamera, AllOfTheSceneIsFramed) {
    for (const Projection kind : {Projection::Perspective, Projection::Orthographic})
        for (const float aspect : {0.25F, 1.0F, 16.0F / 9})
            for (const float size : {0.01F, 1.0F, 1000.0F}) {
                const Box bounds{hall.low * size, hall.high * size};
                FreeCamera camera{.eye = {70, 2, -3}, .yaw = 130, .pitch = 20, .kind = kind};
                frame_all(camera, bounds, aspect);
                Scene scene = seen_from({0, 0, 9}, {0, 0, 0}, kind);
                scene.camera.near_distance = 1e-3F;
                const CameraState state = state_of(scene, {.aspect = aspect, .orbit = override_of(camera, bounds)});
                float widest = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    const vec3 point((corner & 1) != 0 ? bounds.low.x : bounds.high.x,
                                     (corner & 2) != 0 ? bounds.low.y : bounds.high.y,
                                     (corner & 4) != 0 ? bounds.low.z : bounds.high.z);
                    const vec3 seen = projected(state, point);
                    EXPECT_GT(seen.z, 0) << "before the far plane";
                    EXPECT_LT(seen.z, 1);
                    widest = std::max({widest, std::abs(seen.x), std::abs(seen.y)});
                }
                EXPECT_LE(widest, 1);
                EXPECT_GT(widest, 0.5F);
            }
    FreeCamera camera;
    frame_all(camera, {}, 1);
    EXPECT_EQ(camera.eye, FreeCamera().eye);
}

TEST(SceneFreeCamera, MotionIsThatOfTheHandNotOfThePath) {
    Scene scene = seen_from({9, 9, 9}, {0, 0, 0});
    scene.camera.path = {{.time = 0, .position = {0, 0, 10}, .field_of_view = 40},
                         {.time = 1, .position = {4, 0, 10}, .field_of_view = 60}};
    FreeCamera camera{.eye = {1, 2, 3}, .field_of_view = 50};
    const OrbitOverride before = override_of(camera);
    fly(camera, {1, 0, 0});
    look_around(camera, 5, 0);
    camera.field_of_view = 55;
    const OrbitOverride now = override_of(camera);
    for (const double previous_time : {0.25, 0.5}) {
        const CameraState state =
            state_of(scene, {.time = 0.5, .previous_time = previous_time, .orbit = now, .previous_orbit = before});
        EXPECT_EQ(state.view, state_of(scene, {.orbit = now}).view);
        EXPECT_EQ(state.previous_view, state_of(scene, {.orbit = before}).view);
        EXPECT_EQ(state.previous_projection, state_of(scene, {.orbit = before}).projection);
    }
    // The first frame that a hand moves comes after one of the path.
    const CameraState first =
        state_of(scene, {.time = 0.5, .previous_time = 0.25, .orbit = now, .previous_orbit = OrbitOverride{}});
    EXPECT_EQ(first.previous_view, state_of(scene, {.time = 0.25}).view);
}

TEST(SceneFreeCamera, TheFarPlaneIsOnlyEverMovedAway) {
    Scene scene = seen_from({0, 0, 9}, {0, 0, 0});
    scene.camera.far_distance = 50;
    FreeCamera camera = free_camera(state_of(scene));
    EXPECT_EQ(state_of(scene, {.orbit = override_of(camera, hall)}).far_distance, 50);
    camera.eye.z = 100;
    EXPECT_NEAR(state_of(scene, {.orbit = override_of(camera, hall)}).far_distance, 108, 0.5F);
}

}  // namespace darkroom::scene
