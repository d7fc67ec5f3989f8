// SPDX-License-Identifier: MIT
#include "scene/walk/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/walk/walk_test_support.hpp"

namespace darkroom::scene {

namespace {

using test::box;
using test::ground_of;

constexpr vec3 down(0, -1, 0);

/// A scene of this one mesh.
Ground ground_of_mesh(Primitive primitive) {
    for (const Vertex& vertex : primitive.vertices) primitive.bounds.add(vertex.position);
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.meshes.push_back({.primitives = {std::move(primitive)}});
    model.nodes = {{.mesh = 0}};
    assets.entities = {{.model = 0}};
    Scene scene;
    scene.entities = {{.name = "mesh", .model = ModelReference{}}};
    return {scene, assets};
}

}  // namespace

TEST(SceneGround, RaysMeetTheNearestSideOfABox) {
    const Ground ground = ground_of({box({-1, 0, -1}, {1, 2, 1}), box({-1, -5, -1}, {1, -4, 1})});
    const std::optional<RayHit> top = ground.cast({0.3F, 5, 0.2F}, down, 10);
    ASSERT_TRUE(top);
    EXPECT_FLOAT_EQ(top->distance, 3);
    EXPECT_EQ(top->normal, vec3(0, 1, 0));
    const std::optional<RayHit> inside = ground.cast({0.3F, 1, 0.2F}, vec3(1, 0, 0), 10);
    ASSERT_TRUE(inside);
    EXPECT_FLOAT_EQ(inside->distance, 0.7F);
    EXPECT_EQ(inside->normal, vec3(-1, 0, 0)) << "both sides are solid";
    const vec3 aslant = glm::normalize(vec3(3, 1, 0));
    ASSERT_TRUE(ground.cast({-4, 0.5F, 0}, aslant, 10));
    EXPECT_FLOAT_EQ(ground.cast({-4, 0.5F, 0}, aslant, 10)->distance, std::sqrt(10.0F));
    EXPECT_FALSE(ground.cast({0.3F, 5, 0.2F}, down, 2.9F)) << "out of reach";
    EXPECT_FALSE(ground.cast({1.1F, 5, 0.2F}, down, 100));
    EXPECT_FALSE(ground.cast({300, 5, -700}, down, 100));
    EXPECT_FALSE(Ground().cast({0, 5, 0}, down, 100));
    EXPECT_FALSE(ground_of({}).cast({0, 5, 0}, down, 100));
}

TEST(SceneGround, NothingFallsThroughWhereTrianglesMeet) {
    Primitive sheet;
    constexpr std::uint32_t side = 40;
    for (std::uint32_t z = 0; z <= side; ++z)
        for (std::uint32_t x = 0; x <= side; ++x)
            sheet.vertices.push_back({.position = {static_cast<float>(x) * 0.3F, 1, static_cast<float>(z) * 0.3F}});
    for (std::uint32_t z = 0; z < side; ++z)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t at = z * (side + 1) + x;
            for (const std::uint32_t corner : {at, at + side + 1, at + 1, at + 1, at + side + 1, at + side + 2})
                sheet.indices.push_back(corner);
        }
    const Ground ground = ground_of_mesh(sheet);
    EXPECT_EQ(ground.triangle_count(), 2 * side * side);
    for (std::uint32_t z = 0; z <= 4 * side; ++z)
        for (std::uint32_t x = 0; x <= 4 * side; ++x) {
            const vec3 from(static_cast<float>(x) * 0.075F, 3, static_cast<float>(z) * 0.075F);
            const std::optional<RayHit> hit = ground.cast(from, down, 10);
            ASSERT_TRUE(hit) << from.x << ", " << from.z;
            EXPECT_NEAR(hit->distance, 2, 1e-5F);
        }
}

TEST(SceneGround, OnlyWhatStandsStillIsSolid) {
    Entity lift = box({-1, 0, -1}, {1, 1, 1});
    lift.path = {{.time = 0}, {.time = 10, .transform = {.position = {0, 9, 0}}}};
    Entity room = box({3, 0, 3}, {5, 1, 5});
    room.archetype = "room";
    Entity mask = box({6, 0, 6}, {8, 1, 8});
    mask.material = Material{.writes = Writes::Alpha};
    const Ground ground = ground_of({lift, room, mask, box({-9, 0, -9}, {-8, 1, -8})});
    EXPECT_EQ(ground.triangle_count(), 12U);
    EXPECT_FALSE(ground.cast({0, 20, 0}, down, 100));
    EXPECT_FALSE(ground.cast({4, 20, 4}, down, 100));
    EXPECT_FALSE(ground.cast({7, 20, 7}, down, 100));
    EXPECT_TRUE(ground.cast({-8.5F, 20, -8.5F}, down, 100));
}

TEST(SceneGround, AMeshBeyondTheBudgetIsItsBox) {
    Primitive huge;
    huge.vertices = {{.position = {0, 0, 0}}, {.position = {0, 0, 4}}, {.position = {4, 2, 0}}};
    for (std::size_t i = 0; i <= Ground::max_triangles; ++i)
        for (const std::uint32_t corner : {0U, 1U, 2U}) huge.indices.push_back(corner);
    const Ground ground = ground_of_mesh(huge);
    EXPECT_EQ(ground.triangle_count(), 12U);
    ASSERT_TRUE(ground.cast({1, 5, 1}, down, 10));
    EXPECT_FLOAT_EQ(ground.cast({1, 5, 1}, down, 10)->distance, 3);
}

TEST(SceneGround, TrianglesThatLieOverEachOtherStayWithinTheBudget) {
    Primitive pile;
    pile.vertices = {{.position = {0, 0, 0}}, {.position = {0, 0, 4}}, {.position = {4, 0, 0}}};
    for (std::size_t i = 0; i < 100'000; ++i)
        for (const std::uint32_t corner : {0U, 1U, 2U}) pile.indices.push_back(corner);
    const Ground ground = ground_of_mesh(pile);
    EXPECT_EQ(ground.triangle_count(), 100'000U);
    EXPECT_LE(ground.link_count(), Ground::max_links);
    ASSERT_TRUE(ground.cast({1, 5, 1}, down, 10));
    EXPECT_FLOAT_EQ(ground.cast({1, 5, 1}, down, 10)->distance, 5);
}

TEST(SceneGround, WhatIsNoPlaceIsLeftOut) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    Primitive broken;
    broken.vertices = {{.position = {0, nan, 0}}, {.position = {0, 0, infinity}}, {.position = {4, 0, 0}},
                       {.position = {0, 1, 0}},   {.position = {0, 1, 4}},        {.position = {4, 1, 0}}};
    broken.indices = {0, 1, 2, 2, 2, 2, 3, 4, 5};
    const Ground ground = ground_of_mesh(broken);
    EXPECT_EQ(ground.triangle_count(), 1U);
    ASSERT_TRUE(ground.cast({1, 5, 1}, down, 10));
    EXPECT_FALSE(ground.cast({nan, 5, 1}, down, 10));
    EXPECT_FALSE(ground.cast({1, 5, 1}, down, nan));
}

}  // namespace darkroom::scene
