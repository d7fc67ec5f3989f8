// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "render/light/brdf_reference.hpp"
#include "render/renderer_test_support.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::render {
namespace {

using namespace test;
using glm::dvec3;

constexpr VkExtent2D frame_extent{64, 48};
const dvec3 sphere_center(0.3, -0.2, -4);
constexpr double floor_height = -1.5;

/// A sphere of radius 1 around 0.
scene::Assets sphere_assets() {
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

scene::SnapshotMaterial material_of(vec3 color, float metallic, float roughness) {
    scene::SnapshotMaterial material;
    material.surface.base_color = vec4(color, 1);
    material.surface.metallic = metallic;
    material.surface.roughness = roughness;
    return material;
}

/// The sphere over the floor.
scene::Snapshot sphere_and_floor(const scene::SnapshotMaterial& sphere, const scene::SnapshotMaterial& floor) {
    scene::Snapshot snapshot = snapshot_of(frame_extent);
    add_box(snapshot, {-20, floor_height - 1, -40}, {20, floor_height, 0}, floor);
    scene::Instance& instance = add_box(snapshot, vec3(sphere_center - 1.0), vec3(sphere_center + 1.0), sphere);
    instance.mesh = {0, 0, 0};
    instance.world = instance.previous_world = glm::translate(mat4(1), vec3(sphere_center));
    return snapshot;
}

/// What a ray from the camera's position through a pixel's centre meets.
struct Hit {
    bool is_sphere = false;
    dvec3 position{0}, normal{0}, to_camera{0};
    double facing = 0;  ///< cosine to the camera
};

/// Calls `compare` for pixels that are well inside the sphere or the floor.
void for_each_hit(const std::function<void(std::uint32_t, std::uint32_t, const Hit&)>& compare) {
    int spheres = 0, floors = 0;
    for (std::uint32_t y = 0; y < frame_extent.height; ++y) {
        for (std::uint32_t x = 0; x < frame_extent.width; ++x) {
            const dvec3 ray = glm::normalize(dvec3((x + 0.5 - 32) / 24, (24 - (y + 0.5)) / 24, -1));
            const double along = glm::dot(ray, sphere_center);
            const double beside = glm::length(sphere_center - ray * along);
            Hit hit{.to_camera = -ray};
            if (beside < 0.95) {
                hit.is_sphere = true;
                hit.position = ray * (along - std::sqrt(1 - beside * beside));
                hit.normal = hit.position - sphere_center;
                ++spheres;
            } else if (beside > 1.1 && ray.y < -0.1) {
                hit.position = ray * (floor_height / ray.y);
                hit.normal = {0, 1, 0};
                ++floors;
            } else {
                continue;
            }
            hit.facing = glm::dot(hit.normal, hit.to_camera);
            compare(x, y, hit);
        }
    }
    EXPECT_GT(spheres, 80);
    EXPECT_GT(floors, 400);
}

void expect_color(const Pixels& pixels, std::uint32_t x, std::uint32_t y, const dvec3& truth, double relative,
                  double absolute) {
    const auto color = pixels.at(x, y);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(color[static_cast<std::size_t>(c)], truth[c], relative * truth[c] + absolute)
            << x << ", " << y << ", " << c;
    }
}

/// One light of each kind, without shadows.
std::vector<scene::LightState> three_lights() {
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

dvec3 reflected_light(const scene::LightState& state, const reference::Reflectance& surface, const Hit& hit) {
    const scene::Light& light = state.light;
    const dvec3 color = dvec3(light.color) * double(light.intensity);
    if (light.type == scene::LightType::Directional)
        return color * reference::reflected(surface, hit.normal, hit.to_camera, dvec3(state.direction));
    const dvec3 to_light = dvec3(state.position) - hit.position;
    const dvec3 direction = glm::normalize(to_light);
    double attenuation = reference::distance_attenuation(glm::length(to_light), light.range);
    if (light.type == scene::LightType::Spot)
        attenuation *= reference::cone_attenuation(glm::dot(-direction, dvec3(state.direction)),
                                                   std::cos(light.outer_angle), std::cos(light.inner_angle));
    return color * attenuation * reference::reflected(surface, hit.normal, hit.to_camera, direction);
}

TEST(RenderGpuShadingScene, SphereAndFloorInPerspectiveHaveTheirClosedForms) {
    scene::Scene scene;
    scene.environment.ambient_intensity = 0.5F;
    Renderer renderer = renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, sphere_assets(), scene);
    scene::SnapshotMaterial metal = material_of({0.9F, 0.7F, 0.3F}, 0.8F, 0.45F);
    metal.surface.emissive = {0.25F, 0, 0.125F};
    const scene::SnapshotMaterial stone = material_of({0.5F, 0.4F, 0.3F}, 0, 0.6F);
    scene::Snapshot snapshot = sphere_and_floor(metal, stone);
    snapshot.lights = three_lights();
    const Shot shot = shoot(renderer, snapshot);
    for_each_hit([&](std::uint32_t x, std::uint32_t y, const Hit& hit) {
        const scene::ModelMaterial& material = hit.is_sphere ? metal.surface : stone.surface;
        const dvec3 color(material.base_color);
        const reference::Reflectance surface = reference::reflectance(color, material.metallic, material.roughness);
        dvec3 truth = color * 0.5 * reference::hemisphere(hit.normal, {0.12, 0.13, 0.18}, {0.06, 0.05, 0.04}) +
                      dvec3(material.emissive);
        for (const scene::LightState& light : snapshot.lights) truth += reflected_light(light, surface, hit);
        // Facets shift what is seen by (pi / 96)^2 / 8 over the cosine to the camera, the more the steeper the lobe is;
        // half floats are truncated to 1e-3.
        expect_color(shot.color, x, y, truth, hit.is_sphere ? 0.01 : 0.002, 1e-3);
    });
}

TEST(RenderGpuShadingScene, WhiteSurfacesInAWhiteSkyAreWhite) {
    scene::Assets assets = sphere_assets();
    assets.skybox.emplace(32, 16);
    std::ranges::fill(assets.skybox->pixels, 1.0F);
    Renderer renderer = renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, assets);
    for (const float metallic : {0.0F, 1.0F}) {
        for (const float roughness : {0.0F, 0.5F, 1.0F}) {
            const scene::SnapshotMaterial white = material_of(vec3(1), metallic, roughness);
            const Shot shot = shoot(renderer, sphere_and_floor(white, white));
            for_each_hit([&](std::uint32_t x, std::uint32_t y, const Hit&) {
                // Half floats of maps and target, each truncated by less than 1e-3.
                expect_color(shot.color, x, y, dvec3(1), 0, 2e-3);
            });
        }
    }
}

TEST(RenderGpuShadingScene, DisplayIsWithinACodeOfTheFinishedHdrPicture) {
    const scene::Assets assets = sphere_assets();
    const scene::SnapshotMaterial metal = material_of({0.9F, 0.7F, 0.3F}, 1, 0.4F);
    const scene::SnapshotMaterial stone = material_of({0.5F, 0.4F, 0.3F}, 0, 0.9F);
    scene::Snapshot snapshot = sphere_and_floor(metal, stone);
    snapshot.lights = three_lights();
    Renderer hdr_renderer = renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, assets);
    Renderer display_renderer =
        renderer_for({.extent = frame_extent, .output = Output::Display, .draw = {.has_shadows = false}}, assets);
    const Pixels hdr = shoot(hdr_renderer, snapshot).color;
    const Pixels display = shoot(display_renderer, snapshot).color;
    for (std::size_t i = 0; i < hdr.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const double x = hdr.rgba[i];
        const double mapped = std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0);
        const double encoded = srgb_encoded(mapped);
        EXPECT_NEAR(display.rgba[i] * 255, encoded * 255, 1) << i / 4 << ", " << i % 4;
    }
}

}  // namespace
}  // namespace darkroom::render
