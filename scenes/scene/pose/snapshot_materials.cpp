// SPDX-License-Identifier: MIT
#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

struct Tint {
    std::optional<vec3> color;
    std::optional<float> alpha;
};

/// An entity's own colour, or that of the nearest entity above it that has one.
Tint inherited_tint(const Scene& scene, std::uint32_t entity) {
    // No chain is longer than this unless it is a cycle.
    for (std::size_t step = 0; step < scene.entities.size() && entity < scene.entities.size(); ++step) {
        const std::optional<Material>& material = scene.entities[entity].material;
        if (material && (material->color || material->alpha)) return {material->color, material->alpha};
        entity = scene.entities[entity].parent;
    }
    return {};
}

void apply_blend(const Material& given, bool is_translucent, ModelMaterial& surface) {
    if (given.blend)
        surface.blend = *given.blend;
    else if (is_translucent)
        surface.blend = SurfaceBlend::Alpha;
}

}  // namespace

BoxSurface box_surface(const Scene& scene, const Assets& assets, std::uint32_t entity) {
    const Entity& source = scene.entities[entity];
    const vec4 archetype = archetype_color(source.archetype);
    BoxSurface out;
    ModelMaterial& surface = out.material.surface;
    surface.name = source.name;
    surface.metallic = 0;
    surface.roughness = 0.7F;
    surface.base_color = archetype;
    out.is_wireframe = !source.material && archetype.w < 1;
    if (!source.material) return out;
    const Material& given = *source.material;
    surface.base_color = vec4(given.color.value_or(vec3(archetype)), given.alpha.value_or(1.0F));
    surface.metallic = given.metallic.value_or(surface.metallic);
    surface.roughness = given.roughness.value_or(surface.roughness);
    surface.emissive = given.emissive.value_or(vec3(0)) * given.emissive_strength;
    surface.alpha_cutoff = given.alpha_cutoff.value_or(surface.alpha_cutoff);
    apply_blend(given, given.opacity < 1 || surface.base_color.w < 1, surface);
    out.material.opacity = given.opacity;
    out.material.writes = given.writes;
    out.material.entity_texture = assets_of(assets, entity).material_texture;
    // A side shows the whole texture once, and nothing of its other edge.
    surface.base_color_texture.wrap_u = surface.base_color_texture.wrap_v = Wrap::Clamp;
    return out;
}

SnapshotMaterial model_surface(const Scene& scene, const Assets& assets, std::uint32_t entity, std::uint32_t material) {
    const EntityAssets own = assets_of(assets, entity);
    const Model& model = assets.models[own.model];
    SnapshotMaterial out;
    out.model = own.model;
    if (material < model.materials.size()) out.surface = model.materials[material];
    ModelMaterial& surface = out.surface;
    if (surface.blend == SurfaceBlend::Opaque) surface.base_color.w = 1;  // glTF 2.0, 3.9.4: alpha is ignored
    const Material given = scene.entities[entity].material.value_or(Material{});
    const Tint tint = inherited_tint(scene, entity);
    if (tint.color) surface.base_color = vec4(*tint.color, surface.base_color.w);
    if (tint.alpha) surface.base_color.w = *tint.alpha;
    surface.metallic = given.metallic.value_or(surface.metallic);
    surface.roughness = given.roughness.value_or(surface.roughness);
    surface.emissive = given.emissive.value_or(surface.emissive) * given.emissive_strength;
    surface.alpha_cutoff = given.alpha_cutoff.value_or(surface.alpha_cutoff);
    apply_blend(given, given.opacity < 1 || tint.alpha.value_or(1.0F) < 1, surface);
    out.opacity = given.opacity;
    out.writes = given.writes;
    if (own.material_texture != no_index) {
        out.entity_texture = own.material_texture;
        surface.base_color_texture.image = no_index;
    }
    return out;
}

bool casts_shadow(const SnapshotMaterial& material) {
    return material.surface.blend != SurfaceBlend::Additive && material.surface.blend != SurfaceBlend::Multiply &&
           material.writes == Writes::All;
}

}  // namespace darkroom::scene
