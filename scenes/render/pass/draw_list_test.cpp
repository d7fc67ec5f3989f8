// SPDX-License-Identifier: MIT
#include "render/pass/draw_list.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace darkroom::render {
namespace {

using scene::Box;
using scene::mat4;
using scene::SurfaceBlend;
using scene::vec3;
using scene::vec4;

/// y down, depth reversed, as scene::CameraState has it.
mat4 perspective(float field_of_view, float aspect, float near_distance, float far_distance) {
    mat4 m(0);
    const float scale = 1 / std::tan(glm::radians(field_of_view) / 2);
    m[0][0] = scale / aspect;
    m[1][1] = -scale;
    m[2][2] = near_distance / (far_distance - near_distance);
    m[2][3] = -1;
    m[3][2] = near_distance * far_distance / (far_distance - near_distance);
    return m;
}

Box cube(vec3 center, float half = 0.5F) { return {center - half, center + half}; }

scene::Snapshot empty_snapshot() {
    scene::Snapshot snapshot;
    snapshot.camera.projection = perspective(90, 1, 0.1F, 100);
    snapshot.materials.resize(1);
    return snapshot;
}

void add(scene::Snapshot& snapshot, vec3 center, std::uint32_t material = 0, scene::MeshId mesh = {}) {
    snapshot.instances.push_back({.mesh = mesh, .bounds = cube(center), .material = material});
}

std::uint32_t add_material(scene::Snapshot& snapshot, SurfaceBlend blend) {
    snapshot.materials.push_back({.surface = {.blend = blend}});
    return static_cast<std::uint32_t>(snapshot.materials.size() - 1);
}

TEST(RenderDrawList, FrustumKeepsWhatItTouchesOnEverySide) {
    const Frustum frustum(perspective(90, 1, 0.1F, 100));
    EXPECT_TRUE(frustum.touches(cube({0, 0, -10})));
    EXPECT_TRUE(frustum.touches(cube({0, 0, 0}))) << "the eye is inside";
    EXPECT_FALSE(frustum.touches(cube({0, 0, 2})));
    EXPECT_TRUE(frustum.touches(cube({0, 0, -100})));
    EXPECT_FALSE(frustum.touches(cube({0, 0, -101})));
    for (const vec3& side : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0)}) {
        EXPECT_TRUE(frustum.touches(cube(vec3(0, 0, -10) + side * 10.2F))) << "reaches over the edge";
        EXPECT_FALSE(frustum.touches(cube(vec3(0, 0, -10) + side * 12.0F)));
    }
    EXPECT_FALSE(frustum.touches(Box{}));
}

TEST(RenderDrawList, FrustumOfAnOrthographicViewIsItsBox) {
    // x, y in [-2, 2], depth 0 at z = 0, 1 at z = -8.
    mat4 m(1);
    m[0][0] = 0.5F;
    m[1][1] = -0.5F;
    m[2][2] = -0.125F;
    const Frustum frustum(m);
    EXPECT_TRUE(frustum.touches(cube({2.4F, 0, -4})));
    EXPECT_FALSE(frustum.touches(cube({2.6F, 0, -4})));
    EXPECT_FALSE(frustum.touches(cube({0, -2.6F, -4})));
    EXPECT_TRUE(frustum.touches(cube({0, 0, -8.4F})));
    EXPECT_FALSE(frustum.touches(cube({0, 0, -8.6F})));
    EXPECT_FALSE(frustum.touches(cube({0, 0, 0.6F})));
}

TEST(RenderDrawList, AThousandBoxesAreOneBatchThoughTheirFactorsDiffer) {
    scene::Snapshot snapshot = empty_snapshot();
    snapshot.materials.resize(1000);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        snapshot.materials[i].surface.base_color = vec4(static_cast<float>(i) / 1000);
        add(snapshot, {0, 0, -5 - 0.01F * static_cast<float>(i)}, i);
    }
    const DrawList list = draw_list(snapshot);
    ASSERT_EQ(list.opaque.size(), 1U);
    EXPECT_EQ(list.opaque[0].count, 1000U);
    EXPECT_EQ(list.order.size(), 1000U);
    EXPECT_EQ(std::set(list.order.begin(), list.order.end()).size(), 1000U) << "each once";
}

TEST(RenderDrawList, BatchesPartWhereTexturesStateOrMeshDiffer) {
    scene::Snapshot snapshot = empty_snapshot();
    const std::uint32_t textured = add_material(snapshot, SurfaceBlend::Opaque);
    snapshot.materials[textured].entity_texture = 3;
    const std::uint32_t double_sided = add_material(snapshot, SurfaceBlend::Opaque);
    snapshot.materials[double_sided].surface.is_double_sided = true;
    add_material(snapshot, SurfaceBlend::Mask);
    const std::uint32_t mask_writer = add_material(snapshot, SurfaceBlend::Opaque);
    snapshot.materials[mask_writer].writes = scene::Writes::Alpha;
    const std::uint32_t clamped = add_material(snapshot, SurfaceBlend::Opaque);
    snapshot.materials[clamped].surface.normal_texture.wrap_v = scene::Wrap::Clamp;
    for (const float x : {0.0F, 1.0F}) {
        for (std::uint32_t material = 0; material < snapshot.materials.size(); ++material)
            add(snapshot, {x, 0, -5}, material);
        add(snapshot, {x, 0, -5}, 0, {.model = 0, .mesh = 1});
        add(snapshot, {x, 0, -5});
        snapshot.instances.back().is_mirrored = true;
        add(snapshot, {x, 0, -5}, 0, {.model = 0, .mesh = 1});
        snapshot.instances.back().first_joint = 7;
    }
    const DrawList list = draw_list(snapshot);
    EXPECT_EQ(list.opaque.size(), snapshot.materials.size() - 1 + 3);
    ASSERT_EQ(list.transparent.size(), 1U);
    EXPECT_EQ(list.transparent[0].material, mask_writer);
    for (const Batch& batch : list.opaque) {
        EXPECT_EQ(batch.count, 2U);
        const scene::Instance& first = snapshot.instances[list.order[batch.first]];
        const scene::Instance& second = snapshot.instances[list.order[batch.first + 1]];
        EXPECT_EQ(first.mesh, second.mesh);
        EXPECT_EQ(first.material, second.material);
        EXPECT_EQ(batch.material, first.material);
        EXPECT_EQ(batch.is_mirrored, second.is_mirrored);
        EXPECT_EQ(batch.is_skinned, second.first_joint != scene::no_index);
    }
}

TEST(RenderDrawList, BatchesPartWhereMaterialsHaveOtherLayers) {
    scene::Snapshot snapshot = empty_snapshot();
    for (const float index : {1.5F, 1.8F, 2.4F}) {
        const std::uint32_t material = add_material(snapshot, SurfaceBlend::Opaque);
        snapshot.materials[material].surface.specular.index_of_refraction = index;
        add(snapshot, {0, 0, -5}, material);
    }
    EXPECT_EQ(draw_list(snapshot).opaque.size(), 2U);
    snapshot.materials[1].surface.clearcoat.weight = 1;
    snapshot.materials[2].surface.clearcoat.weight = 1;
    EXPECT_EQ(draw_list(snapshot).opaque.size(), 3U);
    snapshot.materials[3].surface.clearcoat.weight = 1;
    EXPECT_EQ(draw_list(snapshot).opaque.size(), 2U);
    snapshot.materials[3].surface.sheen.color.y = 0.1F;
    EXPECT_EQ(draw_list(snapshot).opaque.size(), 3U);
}

TEST(RenderDrawList, TransparentOnesGoFromBackToFront) {
    scene::Snapshot snapshot = empty_snapshot();
    const std::uint32_t glass = add_material(snapshot, SurfaceBlend::Alpha),
                        fire = add_material(snapshot, SurfaceBlend::Additive);
    add(snapshot, {0, 0, -5}, glass);
    add(snapshot, {0, 0, -20}, glass);
    add(snapshot, {0, 0, -10}, fire);
    add(snapshot, {0, 0, -15}, glass);
    const DrawList list = draw_list(snapshot);
    EXPECT_TRUE(list.opaque.empty());
    EXPECT_EQ(list.order, (std::vector<std::uint32_t>{1, 3, 2, 0}));
    ASSERT_EQ(list.transparent.size(), 3U);
    EXPECT_EQ(list.transparent[0].count, 2U) << "neighbours of one state still share a call";
}

TEST(RenderDrawList, OpaqueOnesOfABatchGoFromFrontToBack) {
    scene::Snapshot snapshot = empty_snapshot();
    for (const float distance : {7.0F, 3.0F, 9.0F, 5.0F}) add(snapshot, {0, 0, -distance});
    EXPECT_EQ(draw_list(snapshot).order, (std::vector<std::uint32_t>{1, 3, 0, 2}));
}

TEST(RenderDrawList, OfOpaqueOnesInOnePlaceTheLastIsDrawnAlone) {
    scene::Snapshot snapshot = empty_snapshot();
    const std::uint32_t masked = add_material(snapshot, SurfaceBlend::Mask);
    for (int i = 0; i < 3; ++i) {
        add(snapshot, {0, 0, -5});
        add(snapshot, {1, 0, -5});  // as far away
    }
    for (int i = 0; i < 2; ++i) add(snapshot, {0, 0, -5}, masked);  // holes need not be in one place
    add(snapshot, {0, 0, -5});
    snapshot.instances.back().first_weight = 0;
    const DrawList list = draw_list(snapshot);
    EXPECT_EQ(list.order, (std::vector<std::uint32_t>{8, 5, 4, 7, 6}));
    EXPECT_EQ(list.culled, 4U);
}

TEST(RenderDrawList, WhatIsOutOfViewIsCountedAndNotDrawn) {
    scene::Snapshot snapshot = empty_snapshot();
    add(snapshot, {0, 0, -5});
    add(snapshot, {0, 0, 5});
    add(snapshot, {50, 0, -5});
    const DrawList list = draw_list(snapshot);
    EXPECT_EQ(list.order, std::vector<std::uint32_t>{0});
    EXPECT_EQ(list.culled, 2U);
}

TEST(RenderDrawList, RoomsAreWireframesAndCastNothing) {
    scene::Snapshot snapshot = empty_snapshot();
    add(snapshot, {0, 0, -5});
    add(snapshot, {0, 0, -5});
    snapshot.instances[1].is_wireframe = true;
    const DrawList list = draw_list(snapshot);
    ASSERT_EQ(list.wireframe.size(), 1U);
    EXPECT_EQ(list.order[list.wireframe[0].first], 1U);
    EXPECT_EQ(list.opaque.size(), 1U);
    EXPECT_EQ(caster_list(snapshot, snapshot.camera.projection).order, std::vector<std::uint32_t>{0});
}

TEST(RenderDrawList, CastersAreTransparentOnesTooAndNotThoseThatCastNone) {
    scene::Snapshot snapshot = empty_snapshot();
    const std::uint32_t glass = add_material(snapshot, SurfaceBlend::Alpha);
    const std::uint32_t mask_writer = add_material(snapshot, SurfaceBlend::Opaque);
    snapshot.materials[mask_writer].writes = scene::Writes::Alpha;
    add(snapshot, {0, 0, -5});
    add(snapshot, {0, 0, -6}, glass);
    add(snapshot, {0, 0, -7});
    snapshot.instances.back().casts_shadow = false;
    add(snapshot, {0, 0, 8});
    add(snapshot, {0, 0, -9}, mask_writer);
    const DrawList list = caster_list(snapshot, snapshot.camera.projection);
    EXPECT_EQ(list.order, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(list.opaque.size(), 1U);
    EXPECT_EQ(list.transparent.size(), 1U);
    EXPECT_EQ(list.culled, 1U);
}

TEST(RenderDrawList, TheSameSnapshotGivesTheSameListWhateverTheOrderOfEqualOnes) {
    scene::Snapshot snapshot = empty_snapshot();
    for (std::uint32_t i = 0; i < 64; ++i)
        add(snapshot, {0.01F * static_cast<float>(i), 0, -5}, 0, {.model = 0, .mesh = i % 4});
    const DrawList first = draw_list(snapshot), second = draw_list(snapshot);
    EXPECT_EQ(first.order, second.order);
    for (const Batch& batch : first.opaque) {
        for (std::uint32_t i = 1; i < batch.count; ++i)
            EXPECT_GT(first.order[batch.first + i - 1], first.order[batch.first + i]) << "the last one stays";
    }
}

}  // namespace
}  // namespace darkroom::render
