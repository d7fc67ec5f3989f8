// SPDX-License-Identifier: MIT
#pragma once
// For tests only: where the shadows of a shipped scene, as the renderer draws them, are not those of rays.

#include <cmath>
#include <cstdint>

#include "ssao/ssao_scene_view.hpp"

namespace darkroom::test {

/// Pixels that a light reaches, or would reach, with its shadows against rays. A pixel counts where all rays agree that
/// go to the light from around it: from as far along its surface as an edge may be displaced and softened.
struct ShadowFaults {
    std::uint64_t leaking = 0;  ///< no ray gets through, and more than a fiftieth of the light does
    std::uint64_t acne = 0;     ///< every ray gets through, and more than a fiftieth of the light is missing
    std::uint64_t looked_at = 0;
};

/// One light alone, in a world that has no other light, nothing that shines and nothing that is transparent.
class LitScene {
  public:
    explicit LitScene(const SceneView& scene) : snapshot_(scene.snapshot()) {
        std::erase_if(snapshot_.instances, [&](const scene::Instance& instance) {
            return snapshot_.materials[instance.material].surface.blend > scene::SurfaceBlend::Mask;
        });
        snapshot_.sprites.clear();
        snapshot_.emitters.clear();
        for (scene::SnapshotMaterial& material : snapshot_.materials) {
            material.surface.emissive = scene::vec3(0);
            material.surface.is_unlit = false;
            material.surface.metallic = 0;
            material.surface.roughness = 1;
        }
        scene::Scene dark = scene.scene();
        dark.environment = {};
        dark.environment.ambient_intensity = 0;
        dark.environment.background = scene::vec3(0);
        renderer_.emplace(gpu::test::must(render::Renderer::create(
            gpu::test::device(), dark, scene.assets(), {.extent = picture_extent, .draw = {.has_grid = false}})));
        snapshot_.lights.clear();
        render::test::Shot shot = render::test::shoot(*renderer_, snapshot_);
        unlit_ = std::move(shot.color);
        view.camera = renderer_->frame().camera;
        for (std::size_t i = 0; i < view.depth.pixels.size(); ++i) {
            const float* const normal = &shot.normals.rgba[i * 4];
            view.depth.pixels[i].r = shot.depth.rgba[i * 4];
            view.normals.pixels[i] = {normal[0], normal[1], normal[2], 0};
        }
    }

    /// What the light adds to what the sky gives.
    [[nodiscard]] render::test::Pixels shoot(const scene::LightState& light, bool has_shadow) {
        snapshot_.lights = {light};
        snapshot_.lights[0].light.casts_shadow = has_shadow;
        render::test::Pixels out = render::test::shoot(*renderer_, snapshot_).color;
        for (std::size_t i = 0; i < out.rgba.size(); ++i) out.rgba[i] -= unlit_.rgba[i];
        return out;
    }
    [[nodiscard]] const render::test::Pixels& unlit() const { return unlit_; }
    [[nodiscard]] Frame frame() const { return renderer_->frame(); }
    /// What casts shadows, of what is no more transparent than this.
    [[nodiscard]] TriangleMesh casters(const scene::Assets& assets, scene::SurfaceBlend blend) const {
        scene::Snapshot casting = snapshot_;
        std::erase_if(casting.instances, [](const scene::Instance& instance) { return !instance.casts_shadow; });
        return triangles_of(casting, assets, blend);
    }

    BoxView view{.depth{picture_extent.width, picture_extent.height},
                 .normals{picture_extent.width, picture_extent.height},
                 .camera{}};

  private:
    scene::Snapshot snapshot_;
    render::test::Pixels unlit_;
    std::optional<render::Renderer> renderer_;
};

/// How wide a texel of the light's map is at a pixel, metres; 0 where its shadows fade out.
inline double shadow_texel(const Light& light, double distance) {
    if (light.cascade_count == 0 || distance > 0.74 * double{light.splits[light.cascade_count - 1]}) return 0;
    std::size_t cascade = 0;
    // The last tenth turns into the next one.
    while (cascade + 1 < light.cascade_count && distance > 0.89 * double{light.splits[cascade]}) ++cascade;
    const Matrix& m = light.world_to_cascade[cascade];
    const double across = std::hypot(double{m[0]}, double{m[4]}, double{m[8]});
    return 2 / (across * light.cascades.extent.width);
}

/// Texels that an edge may lie off and reach to either side: two, and what the filter blurs
/// (shaders/light/shadow.glsl).
inline constexpr double sun_reach = 2 + 8, lamp_reach = 2 + 6 + 1;

/// `opaque` casts for sure; what `all` do not block is lit for sure.
/// `map`, where it is given, gets a red pixel for each that leaks, and a green one for acne.
inline ShadowFaults shadow_faults(LitScene& lit, const scene::LightState& light, const OcclusionTruth& opaque,
                                  const OcclusionTruth& all, Picture* map) {
    using scene::vec3;
    const bool is_sun = light.light.type == scene::LightType::Directional;
    const render::test::Pixels open = lit.shoot(light, false);
    const render::test::Pixels shaded = lit.shoot(light, true);
    const Frame frame = lit.frame();
    const float tangent = light.light.type == scene::LightType::Spot && light.light.outer_angle < 1.0472F
                              ? std::tan(light.light.outer_angle)
                              : 1.0F;
    ShadowFaults out;
    for (std::uint32_t y = 0; y < picture_extent.height; ++y)
        for (std::uint32_t x = 0; x < picture_extent.width; ++x) {
            const double distance = lit.view.depth.at(x, y).r;
            const float whole = open.at(x, y)[1];
            // Halves know a fiftieth of a light that is a tenth of what the sky gives.
            if (!(distance > 1e-6 && distance < 1e9) || whole < 0.01F + 0.1F * lit.unlit().at(x, y)[1]) continue;
            const Double3 place = lit.view.point(x, y);
            const Rgba& turned = lit.view.normals.at(x, y);
            const vec3 point(place[0], place[1], place[2]), normal(turned.r, turned.g, turned.b);
            const vec3 to_light = is_sun ? light.direction : light.position - point;
            const float length = is_sun ? 1e4F : glm::length(to_light);
            const vec3 toward = is_sun ? to_light : to_light / length;
            // Beyond 85 degrees nothing is promised. Lamps hang in globes and over coals.
            const float facing = glm::dot(normal, toward);
            if (facing < 0.0872F || length < 0.5F) continue;
            const double texel =
                is_sun ? shadow_texel(frame.lights[0], distance) : 2 * 1.2 * double{length * tangent} / 500;
            if (texel == 0) continue;
            ++out.looked_at;
            const float share = shaded.at(x, y)[1] / whole;
            const bool may_leak = share > 0.02F, may_be_acne = share < 0.98F;
            const vec3 helper = std::abs(toward.y) > 0.9F ? vec3(1, 0, 0) : vec3(0, 1, 0);
            const vec3 right = glm::normalize(glm::cross(helper, toward)), up = glm::cross(toward, right);
            // Not as far as the lamp, which hangs in a globe that light leaves: from inside, maps see nothing of it.
            // From (x, y) texels across the light, on the surface's plane.
            const auto is_met = [&](const OcclusionTruth& rays, float u, float v) {
                const vec3 across = (right * u + up * v) * static_cast<float>(texel);
                const vec3 from = point + across - toward * (glm::dot(across, normal) / facing) + normal * 1e-3F;
                return rays.is_met({from.x, from.y, from.z}, {toward.x, toward.y, toward.z}, double{length} - 0.3);
            };
            const auto is_met_all_around = [&](const OcclusionTruth& rays, bool is_met_here) {
                if (is_met(rays, 0, 0) != is_met_here) return false;
                const double reach = is_sun ? sun_reach : lamp_reach;
                for (const double ring : {0.25, 0.5, 1.0})
                    for (int i = 0; i < 8; ++i) {
                        const double angle = (i + ring) * std::numbers::pi / 4;
                        if (is_met(rays, static_cast<float>(ring * reach * std::cos(angle)),
                                   static_cast<float>(ring * reach * std::sin(angle))) != is_met_here)
                            return false;
                    }
                return true;
            };
            const bool leaks = may_leak && is_met_all_around(opaque, true);
            const bool is_acne = may_be_acne && is_met_all_around(all, false);
            if (leaks) ++out.leaking;
            if (is_acne) ++out.acne;
            if (map != nullptr && leaks) map->at(x, y)[0] = 1;
            if (map != nullptr && is_acne) map->at(x, y)[1] = 1;
        }
    return out;
}

/// Of all lights of the scene that cast shadows, added up.
inline ShadowFaults shadow_faults(const SceneView& view, Picture* map = nullptr) {
    LitScene lit(view);
    const OcclusionTruth opaque(lit.casters(view.assets(), scene::SurfaceBlend::Opaque));
    const OcclusionTruth all(lit.casters(view.assets(), scene::SurfaceBlend::Mask));
    if (map != nullptr) *map = Picture(picture_extent.width, picture_extent.height);
    ShadowFaults out;
    for (const scene::LightState& light : view.snapshot().lights) {
        if (!light.light.casts_shadow || !(light.light.intensity > 0)) continue;
        const ShadowFaults here = shadow_faults(lit, light, opaque, all, map);
        fmt::print("  {}: {} pixels leak, {} are acne, of {}\n", light.name, here.leaking, here.acne, here.looked_at);
        out.leaking += here.leaking;
        out.acne += here.acne;
        out.looked_at += here.looked_at;
    }
    return out;
}

}  // namespace darkroom::test
