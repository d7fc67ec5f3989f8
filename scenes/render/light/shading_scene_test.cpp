// SPDX-License-Identifier: MIT
#include "render/light/shading_scene_support.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::render {
namespace {

using namespace test;

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
    const auto truth = [&](const Hit& hit) {
        const scene::ModelMaterial& material = hit.is_sphere ? metal.surface : stone.surface;
        const dvec3 color(material.base_color);
        const reference::Reflectance surface = reference::reflectance(color, material.metallic, material.roughness);
        dvec3 light = color * 0.5 * reference::hemisphere(hit.normal, {0.12, 0.13, 0.18}, {0.06, 0.05, 0.04}) +
                      dvec3(material.emissive);
        for (const scene::LightState& lamp : snapshot.lights) {
            const Arriving arrives = arriving_light(lamp, hit.position);
            light += arrives.color * reference::reflected(surface, hit.normal, hit.to_camera, arrives.direction);
        }
        return light;
    };
    // Facets shift what is seen by (pi / 96)^2 / 8 over the cosine to the camera, the more the steeper the lobe is;
    // half floats are truncated to 1e-3.
    expect_hits(shot.color, truth, 0.01, 0.002, 1e-3);
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
