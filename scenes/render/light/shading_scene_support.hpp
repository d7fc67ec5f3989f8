// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a sphere over a floor, drawn by the renderer, whose normals and places are known for every pixel, and
// three lights.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "render/light/brdf_reference.hpp"
#include "render/light/shading_test_support.hpp"
#include "render/renderer_test_support.hpp"

namespace darkroom::render::test {

using glm::dvec3;

inline constexpr VkExtent2D frame_extent{64, 48};
inline const dvec3 sphere_center(0.3, -0.2, -4);
inline constexpr double floor_height = -1.5;

/// A sphere of radius 1 around 0.
inline scene::Assets sphere_assets() {
    constexpr std::uint32_t rings = 96;
    scene::Primitive sphere;
    for (std::uint32_t y = 0; y <= rings; ++y) {
        for (std::uint32_t x = 0; x <= rings; ++x) {
            const double around = 2 * std::numbers::pi * x / rings, down = std::numbers::pi * y / rings;
            const vec3 n(dvec3(std::sin(down) * std::sin(around), std::cos(down), std::sin(down) * std::cos(around)));
            sphere.vertices.push_back({.position = n, .normal = n});
            if (x == rings || y == rings) continue;
            const std::uint32_t corner = y * (rings + 1) + x;
            for (const std::uint32_t step : {0U, rings + 1, 1U, 1U, rings + 1, rings + 2})
                sphere.indices.push_back(corner + step);
        }
    }
    scene::Assets assets;
    assets.models.resize(1);
    assets.models[0].meshes.push_back({.name = "sphere", .primitives = {sphere}});
    return assets;
}

inline scene::SnapshotMaterial material_of(vec3 color, float metallic, float roughness) {
    scene::SnapshotMaterial material;
    material.surface.base_color = vec4(color, 1);
    material.surface.metallic = metallic;
    material.surface.roughness = roughness;
    return material;
}

/// The sphere over the floor.
inline scene::Snapshot sphere_and_floor(const scene::SnapshotMaterial& sphere, const scene::SnapshotMaterial& floor) {
    scene::Snapshot snapshot = snapshot_of(frame_extent);
    // It ends behind the camera: SwiftShader takes a triangle with a corner in the camera's own plane, where w is -0,
    // for one that is seen from its back.
    add_box(snapshot, {-20, floor_height - 1, -40}, {20, floor_height, 1}, floor);
    scene::Instance& instance = add_box(snapshot, vec3(sphere_center - 1.0), vec3(sphere_center + 1.0), sphere);
    instance.mesh = {0, 0, 0};
    instance.world = instance.previous_world = glm::translate(mat4(1), vec3(sphere_center));
    return snapshot;
}

/// What a ray from the camera's position through a place of the picture meets.
struct Hit {
    bool is_sphere = false;
    dvec3 position{0}, normal{0}, to_camera{0};
    double facing = 0;  ///< cosine to the camera
};

/// The hit at a place that is well inside the sphere or the floor.
inline std::optional<Hit> hit_at(double x, double y) {
    const dvec3 ray = glm::normalize(dvec3((x - 32) / 24, (24 - y) / 24, -1));
    const double along = glm::dot(ray, sphere_center);
    const double beside = glm::length(sphere_center - ray * along);
    Hit hit{.to_camera = -ray};
    if (beside < 0.95) {
        hit.is_sphere = true;
        hit.position = ray * (along - std::sqrt(1 - beside * beside));
        hit.normal = hit.position - sphere_center;
    } else if (beside > 1.1 && ray.y < -0.1) {
        hit.position = ray * (floor_height / ray.y);
        hit.normal = {0, 1, 0};
    } else {
        return {};
    }
    hit.facing = glm::dot(hit.normal, hit.to_camera);
    return hit;
}

/// Calls `compare` for the centres of pixels that are well inside the sphere or the floor.
inline void for_each_hit(const std::function<void(std::uint32_t, std::uint32_t, const Hit&)>& compare) {
    int spheres = 0, floors = 0;
    for (std::uint32_t y = 0; y < frame_extent.height; ++y) {
        for (std::uint32_t x = 0; x < frame_extent.width; ++x) {
            const std::optional<Hit> hit = hit_at(x + 0.5, y + 0.5);
            if (!hit) continue;
            ++(hit->is_sphere ? spheres : floors);
            compare(x, y, *hit);
        }
    }
    EXPECT_GT(spheres, 80);
    EXPECT_GT(floors, 400);
}

/// The color is as close as this to one of the range.
inline void expect_color(const Pixels& pixels, std::uint32_t x, std::uint32_t y, const Range& range, double relative,
                         double absolute) {
    const auto color = pixels.at(x, y);
    for (int c = 0; c < 3; ++c) {
        const double value = color[static_cast<std::size_t>(c)],
                     wanted = std::clamp(value, range.low[c], range.high[c]);
        EXPECT_NEAR(value, wanted, relative * wanted + absolute) << x << ", " << y << ", " << c;
    }
}
inline void expect_color(const Pixels& pixels, std::uint32_t x, std::uint32_t y, const dvec3& truth, double relative,
                         double absolute) {
    expect_color(pixels, x, y, Range{truth, truth}, relative, absolute);
}

/// Compares every pixel that is well inside the sphere or the floor with the truth about what it may show.
inline void expect_hits(const Pixels& pixels, const std::function<dvec3(const Hit&)>& truth, double on_sphere,
                        double on_floor, double absolute) {
    for_each_hit([&](std::uint32_t x, std::uint32_t y, const Hit& hit) {
        const Range shown = around_center(x, y, [&](double right, double down) -> std::optional<dvec3> {
            const std::optional<Hit> other = hit_at(right, down);
            if (!other || other->is_sphere != hit.is_sphere) return {};
            return truth(*other);
        });
        expect_color(pixels, x, y, shown, hit.is_sphere ? on_sphere : on_floor, absolute);
    });
}

/// One light of each kind, without shadows.
inline std::vector<scene::LightState> three_lights() {
    scene::LightState sun{.light = {.color = {1, 0.9F, 0.7F}, .intensity = 2, .casts_shadow = false}};
    sun.direction = glm::normalize(vec3(1, 2, 1));
    scene::LightState lamp{.light = {.type = scene::LightType::Point, .color = {0.2F, 0.5F, 1}, .intensity = 6}};
    lamp.light.range = 5;
    lamp.position = {-1.5F, 0.5F, -3};
    scene::LightState spot{.light = {.type = scene::LightType::Spot, .color = {0.5F, 1, 0.5F}, .intensity = 30}};
    spot.light.range = 8;
    spot.light.inner_angle = 0.2F;
    spot.light.outer_angle = 0.5F;
    spot.position = {2, 2, -3};
    spot.direction = glm::normalize(vec3(-0.2F, -1, -0.2F));
    return {sun, lamp, spot};
}

/// Light of a lamp at a place: what arrives of it, and from where.
struct Arriving {
    dvec3 color{0}, direction{0};
};
inline Arriving arriving_light(const scene::LightState& state, const dvec3& position) {
    const scene::Light& light = state.light;
    const dvec3 color = dvec3(light.color) * double(light.intensity);
    if (light.type == scene::LightType::Directional) return {color, dvec3(state.direction)};
    const dvec3 to_light = dvec3(state.position) - position;
    const dvec3 direction = glm::normalize(to_light);
    double attenuation = reference::distance_attenuation(glm::length(to_light), light.range);
    if (light.type == scene::LightType::Spot)
        attenuation *= reference::cone_attenuation(glm::dot(-direction, dvec3(state.direction)),
                                                   std::cos(light.outer_angle), std::cos(light.inner_angle));
    return {color * attenuation, direction};
}

}  // namespace darkroom::render::test
