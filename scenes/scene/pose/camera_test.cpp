// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

namespace {

Scene seen_from(vec3 position, vec3 target) {
    Scene scene;
    scene.camera.is_given = true;
    scene.camera.position = position;
    scene.camera.target = target;
    return scene;
}

Assets no_assets(const Scene& scene) {
    Assets out;
    out.entities.resize(scene.entities.size());
    return out;
}

CameraState camera(const Scene& scene, const SnapshotOptions& options = {}) {
    return snapshot(scene, no_assets(scene), options).camera;
}

/// x, y of the picture in -1..1 with y down, and depth.
vec3 projected(const CameraState& camera, vec3 point) {
    const vec4 clip = camera.projection * camera.view * vec4(point, 1);
    return vec3(clip) / clip.w;
}

void expect_near(vec3 actual, vec3 expected, float allowed = 1e-5F) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], allowed) << "axis " << axis;
}

void expect_rigid(const mat4& view) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(glm::dot(vec3(view[i]), vec3(view[j])), i == j ? 1 : 0, 1e-5F);
    EXPECT_NEAR(glm::determinant(mat3(view)), 1, 1e-5F);
}

Entity box(vec3 low, vec3 high) { return {.name = "box", .archetype = "wall", .bounds = Box{low, high}}; }

}  // namespace

TEST(SceneCamera, ProjectsKnownPoints) {
    Scene scene = seen_from({0, 0, 5}, {0, 0, 0});
    scene.camera.field_of_view = 90;
    scene.camera.near_distance = 1;
    scene.camera.far_distance = 100;
    const CameraState found = camera(scene, {.aspect = 2});
    expect_near(projected(found, {0, 0, 4}), {0, 0, 1});    // the near plane
    expect_near(projected(found, {0, 0, -95}), {0, 0, 0});  // the far plane
    expect_near(projected(found, {10, 5, 0}), {1, -1, (100.0F - 5) / (99 * 5)});
    expect_near(projected(found, {-10, -5, 0}), {-1, 1, (100.0F - 5) / (99 * 5)});
    EXPECT_FLOAT_EQ((found.projection * vec4(0, 0, -7, 1)).w, 7);
}

TEST(SceneCamera, OrthographicDepthIsLinear) {
    Scene scene = seen_from({0, 0, 5}, {0, 0, 0});
    scene.camera.projection = Projection::Orthographic;
    scene.camera.ortho_height = 4;
    scene.camera.near_distance = 1;
    scene.camera.far_distance = 11;
    const CameraState found = camera(scene, {.aspect = 2});
    expect_near(projected(found, {4, 2, 4}), {1, -1, 1});
    expect_near(projected(found, {-4, 0, -1}), {-1, 0, 0.5F});
    expect_near(projected(found, {0, 0, -6}), {0, 0, 0});
}

TEST(SceneCamera, DegenerateViewsAreViews) {
    for (const vec3& target : {vec3(0, 0, 0), vec3(0, 9, 0), vec3(0, 3, 0)}) {
        const CameraState found = camera(seen_from({0, 3, 0}, target));
        expect_rigid(found.view);
    }
    const CameraState down = camera(seen_from({0, 3, 0}, {0, 0, 0}));
    EXPECT_LT(projected(down, {0, 0, -1}).y, 0) << "-z is at the top";
    EXPECT_GT(projected(down, {1, 0, 0}).x, 0);
}

TEST(SceneCamera, OrbitIsThatOfTheReference) {
    const Scene scene = seen_from({0, 0, 4}, {0, 0, 0});
    const float yaw = glm::radians(30.0F), pitch = glm::radians(20.0F);
    const vec3 outward(std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw));
    const CameraState turned = camera(scene, {.orbit = {.yaw = 30, .pitch = 20}});
    expect_near(turned.position, 4.0F * outward);
    const CameraState moved =
        camera(scene, {.orbit = {.distance = 2, .yaw = 30, .pitch = 20, .target = vec3(1, 2, 3)}});
    expect_near(moved.position, vec3(1, 2, 3) + 2.0F * outward);
    expect_rigid(moved.view);
    const vec3 center = projected(moved, {1, 2, 3});
    EXPECT_NEAR(center.x, 0, 1e-5F);
    EXPECT_NEAR(center.y, 0, 1e-5F);
}

TEST(SceneCamera, OneOverrideKeepsTheOthers) {
    const vec3 position(1, 5, -4), target(3, 2, 1);
    const Scene scene = seen_from(position, target);
    const vec3 offset = position - target;
    expect_near(camera(scene, {.orbit = {.target = vec3(0)}}).position, offset);
    expect_near(camera(scene, {.orbit = {.distance = 1}}).position, target + glm::normalize(offset));
    const vec3 level = camera(scene, {.orbit = {.pitch = 0}}).position;
    expect_near(level, target + glm::length(offset) * glm::normalize(vec3(offset.x, 0, offset.z)));
    const CameraState wide = camera(scene, {.orbit = {.field_of_view = 100}});
    expect_near(wide.position, position);
    EXPECT_EQ(wide.field_of_view, 100);
    EXPECT_NEAR(wide.projection[1][1], -1 / std::tan(glm::radians(50.0F)), 1e-6F);
}

TEST(SceneCamera, OrbitsReachTheZenith) {
    const Scene scene = seen_from({0, 0, 4}, {0, 0, 0});
    const CameraState above = camera(scene, {.orbit = {.yaw = 90, .pitch = 90}});
    expect_near(above.position, {0, 4, 0});
    expect_rigid(above.view);
    const CameraState almost = camera(scene, {.orbit = {.yaw = 90, .pitch = 89.9F}});
    for (int column = 0; column < 3; ++column) expect_near(vec3(above.view[column]), vec3(almost.view[column]), 0.01F);
}

TEST(SceneCamera, PathsAreWalkedAtEvenSpeed) {
    Scene scene = seen_from({9, 9, 9}, {0, 0, 0});
    scene.camera.path = {{.time = 1, .position = {0, 0, 10}, .target = {0, 0, 0}, .field_of_view = 40},
                         {.time = 3, .position = {4, 0, 10}, .target = {4, 2, 0}, .field_of_view = 60}};
    expect_near(camera(scene, {.time = 0}).position, {0, 0, 10});
    expect_near(camera(scene, {.time = 9}).position, {4, 0, 10});
    const CameraState found = camera(scene, {.time = 1.5, .previous_time = 1});
    expect_near(found.position, {1, 0, 10});
    EXPECT_FLOAT_EQ(found.field_of_view, 45);
    const vec3 center = projected(found, {1, 0.5F, 0});
    EXPECT_NEAR(center.x, 0, 1e-5F);
    EXPECT_NEAR(center.y, 0, 1e-5F);
    EXPECT_EQ(found.previous_view, camera(scene, {.time = 1}).view);
    EXPECT_EQ(found.previous_projection, camera(scene, {.time = 1}).projection);
    const CameraState still = camera(scene, {.time = 1.5, .previous_time = 1.5});
    EXPECT_EQ(still.previous_view, still.view);
    EXPECT_EQ(still.previous_projection, still.projection);
}

// Every corner of what there is, whatever the shape of the picture.
TEST(SceneCamera, FitsWhatThereIs) {
    for (const char* file : {"room.scene.toml", "thing.glb"})
        for (const float aspect : {16.0F / 9, 0.25F, 1.0F / 8192, 8192.0F})
            for (const float size : {0.01F, 1.0F, 5000.0F}) {
                Scene scene;
                scene.file = file;
                scene.entities = {box(vec3(3, 4, 5) * size, vec3(4, 6, 8) * size)};
                const CameraState found = camera(scene, {.aspect = aspect});
                float widest = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    const vec3 point((corner & 1) != 0 ? 3 : 4, (corner & 2) != 0 ? 4 : 6, (corner & 4) != 0 ? 5 : 8);
                    const vec3 seen = projected(found, point * size);
                    EXPECT_GT(seen.z, 0);
                    EXPECT_LT(seen.z, 1);
                    EXPECT_LE(std::max(std::abs(seen.x), std::abs(seen.y)), 1.0F);
                    widest = std::max({widest, std::abs(seen.x), std::abs(seen.y)});
                }
                EXPECT_GT(widest, 0.5F) << file << " at aspect " << aspect;
            }
}

TEST(SceneCamera, AFittedViewStandsStill) {
    Scene scene;
    scene.entities = {box(vec3(0), vec3(1))};
    scene.entities[0].path = {{.time = 0}, {.time = 10, .transform = {.position = {50, 0, 0}}}};
    const CameraState found = camera(scene, {.time = 5, .previous_time = 4.9});
    EXPECT_EQ(found.view, camera(scene).view);
    EXPECT_EQ(found.view, found.previous_view);
}

TEST(SceneCamera, AnEmptySceneHasTheViewOfTheReference) {
    const CameraState found = camera(Scene{});
    const float half = std::sqrt(0.5F), level = std::sqrt(0.75F);
    expect_near(found.position, {15 * level * half, 7.5F, 15 * level * half});
    EXPECT_EQ(found.field_of_view, 45);
    EXPECT_EQ(found.near_distance, 0.1F);
    EXPECT_EQ(found.far_distance, 1000);
}

TEST(SceneCamera, ABareModelBringsItsOwn) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.cameras = {
        {.field_of_view = 30, .near_distance = 0.5F, .far_distance = std::numeric_limits<float>::infinity()}};
    model.nodes.resize(2);
    model.nodes[0].transform.rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0));
    model.nodes[1] = {.parent = 0, .transform = {.position = {0, 0, 2}}, .camera = 0};
    assets.entities = {{.model = 0}};
    Scene scene;
    scene.file = "camera.glb";
    scene.entities = {{.name = "camera"}};
    const CameraState found = snapshot(scene, assets, {}).camera;
    expect_near(found.position, {2, 0, 0});
    EXPECT_EQ(found.field_of_view, 30);
    const vec3 ahead = projected(found, {-8, 0, 0});
    expect_near(ahead, {0, 0, 0.05F});  // near / distance, without a far plane
    const CameraState moved = snapshot(scene, assets, {.orbit = {.distance = 5}}).camera;
    expect_near(moved.position, {5, 0, 0});  // goes around the middle of the scene, which is empty
    scene.file = "with.scene.toml";
    EXPECT_EQ(snapshot(scene, assets, {}).camera.field_of_view, 45);
}

TEST(SceneCamera, InsideOfABareModelTheNearPlaneIsAThousandthOfIt) {
    Scene scene;
    scene.file = "room.glb";
    scene.entities = {box(vec3(-1), vec3(1))};
    const float radius = std::sqrt(3.0F);
    EXPECT_NEAR(camera(scene, {.orbit = {.distance = 0.1F}}).near_distance, 0.001F * radius, 1e-6F);
    const CameraState outside = camera(scene, {.orbit = {.distance = 5}});
    EXPECT_NEAR(outside.near_distance, (5 - radius) / 2, 1e-4F);
    EXPECT_NEAR(outside.far_distance, 2 * (5 + radius), 1e-4F);
}

TEST(SceneCamera, TellsOfNumbersThatNoViewHas) {
    Scene scene = seen_from({0, 0, 5}, {0, 0, 0});
    scene.camera.far_distance = scene.camera.near_distance;
    const Snapshot found = snapshot(scene, no_assets(scene), {.orbit = {.field_of_view = 180}});
    ASSERT_EQ(found.warnings.size(), 2U);
    EXPECT_NE(found.warnings[0].find("fov 180"), std::string::npos);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) EXPECT_TRUE(std::isfinite(found.camera.projection[column][row]));
    EXPECT_TRUE(snapshot(seen_from({0, 0, 5}, {0, 0, 0}), Assets{}, {.aspect = 0}).camera.projection[0][0] > 0);
}

}  // namespace darkroom::scene
