// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"
#include "image/table/resource_file.hpp"
#include "info_documents.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"
#include "scene/assets.hpp"
#include "scene/model.hpp"
#include "scene/read/scene_file.hpp"
#include "scene/scene.hpp"
#include "toml/toml_text.hpp"

namespace app::info {

using darkroom::Result;
namespace scenes = darkroom::scene;

namespace {

Json json_of(const scenes::vec3& v) { return {v.x, v.y, v.z}; }

struct Counts {
    std::size_t primitives = 0, triangles = 0, vertices = 0;

    void add(const scenes::Mesh& mesh) {
        primitives += mesh.primitives.size();
        for (const scenes::Primitive& primitive : mesh.primitives) {
            triangles += primitive.indices.size() / 3;
            vertices += primitive.vertices.size();
        }
    }
};

// Each mesh as often as nodes draw it.
Counts drawn(const scenes::Model& model) {
    std::vector<Counts> of_mesh(model.meshes.size());
    for (std::size_t i = 0; i < of_mesh.size(); ++i) of_mesh[i].add(model.meshes[i]);
    Counts out;
    for (const scenes::Node& node : model.nodes) {
        if (node.mesh == scenes::no_index) continue;
        out.primitives += of_mesh[node.mesh].primitives;
        out.triangles += of_mesh[node.mesh].triangles;
        out.vertices += of_mesh[node.mesh].vertices;
    }
    return out;
}

std::string_view name_of(scenes::SurfaceBlend blend) {
    constexpr std::array<std::string_view, 5> names{"opaque", "mask", "alpha", "additive", "multiply"};
    return names[static_cast<std::size_t>(blend)];
}

std::string_view name_of(scenes::LightType type) {
    constexpr std::array<std::string_view, 3> names{"directional", "point", "spot"};
    return names[static_cast<std::size_t>(type)];
}

std::string_view name_of(scenes::Projection projection) {
    return projection == scenes::Projection::Perspective ? "perspective" : "orthographic";
}

Json textures_of(std::span<const scenes::Image> images) {
    Json out = Json::array();
    for (const scenes::Image& image : images)
        out.push_back({{"name", image.name}, {"size", {image.width, image.height}}});
    return out;
}

Json materials_of(const scenes::Model& model) {
    Json out = Json::array();
    for (const scenes::ModelMaterial& material : model.materials) {
        Json textures = Json::array();
        for (const auto& [texture, name] :
             {std::pair(&material.base_color_texture, "base color"),
              std::pair(&material.metallic_roughness_texture, "metallic roughness"),
              std::pair(&material.normal_texture, "normal"), std::pair(&material.occlusion_texture, "occlusion"),
              std::pair(&material.emissive_texture, "emissive")})
            if (texture->is_given()) textures.push_back(name);
        out.push_back({{"name", material.name}, {"blend", name_of(material.blend)}, {"textures", std::move(textures)}});
    }
    return out;
}

Json animations_of(const scenes::Model& model) {
    Json out = Json::array();
    for (const scenes::Animation& animation : model.animations)
        out.push_back(
            {{"name", animation.name}, {"seconds", animation.duration}, {"channels", animation.channels.size()}});
    return out;
}

Json cameras_of(const scenes::Model& model) {
    Json out = Json::array();
    for (const scenes::ModelCamera& camera : model.cameras)
        out.push_back({{"name", camera.name},
                       {"projection", name_of(camera.projection)},
                       {"vertical_field_of_view_degrees", camera.field_of_view}});
    return out;
}

Json light_of(const scenes::Light& light) {
    return {{"type", name_of(light.type)}, {"color", json_of(light.color)}, {"intensity", light.intensity}};
}

Json model_lights_of(const scenes::Model& model) {
    Json out = Json::array();
    for (const scenes::Light& light : model.lights) out.push_back(light_of(light));
    return out;
}

Json camera_of(const scenes::Camera& camera) {
    if (!camera.is_given) return "fitted to what the scene holds";
    Json out{{"projection", name_of(camera.projection)},
             {"position", json_of(camera.position)},
             {"target", json_of(camera.target)}};
    if (camera.projection == scenes::Projection::Perspective)
        out["vertical_field_of_view_degrees"] = camera.field_of_view;
    else
        out["height"] = camera.ortho_height;
    if (!camera.path.empty())
        out.update({{"path_keys", camera.path.size()}, {"path_seconds", camera.path.back().time}});
    return out;
}

Json environment_of(const scenes::Environment& environment, const scenes::Assets& assets) {
    Json out{{"skybox", environment.skybox.empty() ? Json() : Json(environment.skybox.string())}};
    if (assets.skybox) out["skybox_size"] = {assets.skybox->width, assets.skybox->height};
    out["background"] = json_of(environment.background);
    return out;
}

Json scene_models_of(const scenes::Scene& scene, const scenes::Assets& assets) {
    std::vector<std::size_t> uses(assets.models.size());
    for (const scenes::EntityAssets& entity : assets.entities)
        if (entity.model != scenes::no_index) ++uses[entity.model];
    Json out = Json::array();
    for (std::size_t i = 0; i < assets.models.size(); ++i) {
        const scenes::Model& model = assets.models[i];
        const auto user =
            std::ranges::find(assets.entities, static_cast<std::uint32_t>(i), &scenes::EntityAssets::model);
        const auto entity = static_cast<std::size_t>(user - assets.entities.begin());
        const Counts counts = drawn(model);
        out.push_back({{"model", user == assets.entities.end() ? model.name : scene.entities[entity].model->asset},
                       {"entities", uses[i]},
                       {"triangles", counts.triangles},
                       {"vertices", counts.vertices},
                       {"textures", model.images.size()},
                       {"animations", model.animations.size()}});
    }
    return out;
}

Json scene_lights_of(const scenes::Scene& scene) {
    Json out = Json::array();
    for (const scenes::Entity& entity : scene.entities) {
        if (!entity.light) continue;
        Json row{{"entity", entity.name}};
        row.update(light_of(*entity.light));
        row["casts_shadow"] = entity.light->casts_shadow;
        row["volumetric_intensity"] = entity.light->volumetric_intensity;
        out.push_back(std::move(row));
    }
    return out;
}

Json particles_of(const scenes::Scene& scene) {
    Json out = Json::array();
    for (const scenes::Entity& entity : scene.entities)
        if (entity.emitter)
            out.push_back(
                {{"entity", entity.name},
                 {"per_second", entity.emitter->emission_rate},
                 {"at_most", entity.emitter->max_particles},
                 {"lifetime_seconds", {entity.emitter->lifetime_min, entity.emitter->lifetime_max}},
                 {"texture", entity.emitter->texture.empty() ? Json() : Json(entity.emitter->texture.string())}});
    return out;
}

}  // namespace

Result<Json> model(const std::filesystem::path& path, scenes::NamedFiles named_files) {
    DARKROOM_TRY_VALUE(const scenes::Model model, scenes::read_model(path, scenes::Budget(), named_files));
    Counts stored;
    std::size_t targets = 0, joints = 0;
    for (const scenes::Mesh& mesh : model.meshes) {
        stored.add(mesh);
        for (const scenes::Primitive& primitive : mesh.primitives) targets += primitive.targets.size();
    }
    for (const scenes::Skin& skin : model.skins) joints += skin.joints.size();
    Json out{{"kind", "model"},
             {"name", model.name},
             {"nodes", model.nodes.size()},
             {"meshes", model.meshes.size()},
             {"primitives", stored.primitives},
             {"triangles", stored.triangles},
             {"drawn_triangles", drawn(model).triangles},
             {"vertices", stored.vertices},
             {"morph_targets", targets},
             {"skins", model.skins.size()},
             {"joints", joints},
             {"materials", materials_of(model)},
             {"variants", model.variants},
             {"textures", textures_of(model.images)},
             {"animations", animations_of(model)},
             {"cameras", cameras_of(model)},
             {"lights", model_lights_of(model)}};
    if (!model.warnings.empty()) out["warnings"] = model.warnings;
    return out;
}

Result<Json> scene(const std::string& text, const std::filesystem::path& path, scenes::NamedFiles named_files) {
    std::vector<std::string> warnings;
    DARKROOM_TRY_VALUE(const scenes::Scene scene,
                       scenes::parse_scene(text, path, {.warnings = &warnings, .named_files = named_files}));
    const scenes::Assets assets = scenes::load_assets(scene);
    const auto count = [&](auto member) {
        return std::ranges::count_if(scene.entities, [&](const scenes::Entity& e) { return (e.*member).has_value(); });
    };
    Json out{{"name", scene.name},
             {"description", scene.description},
             {"time", scene.time},
             {"entities", scene.entities.size()},
             {"boxes", count(&scenes::Entity::bounds)},
             {"sprites", count(&scenes::Entity::sprite)},
             {"camera", camera_of(scene.camera)},
             {"environment", environment_of(scene.environment, assets)},
             {"models", scene_models_of(scene, assets)},
             {"textures", textures_of(assets.images)},
             {"lights", scene_lights_of(scene)},
             {"particles", particles_of(scene)}};
    warnings.insert(warnings.end(), assets.warnings.begin(), assets.warnings.end());
    if (!warnings.empty()) out["warnings"] = warnings;
    return out;
}

namespace {

void add_values(Json& out, const darkroom::LookEntry& entry) {
    for (const darkroom::ParamInfo& row : entry.effect->parameters.rows) {
        const std::string value = darkroom::value_text(entry, row);
        if (value != darkroom::format(row, entry.effect->parameters.defaults))
            out[std::string(row.name)] = Json::value_or_text(value);
    }
}

Json wires_of(const darkroom::LookEntry& entry) {
    Json out = Json::object();
    for (const darkroom::WireInfo& wire : darkroom::wires)
        if (wire.member != &darkroom::LookEntry::name && !(entry.*wire.member).empty())
            out[std::string(wire.key)] = entry.*wire.member;
    return out;
}

Json look_of(const darkroom::Look& look) {
    Json out{{"form", look.is_flat ? "[post_process]" : "[[stack]]"}};
    if (look.is_flat) {
        out["order"] = darkroom::order_names[static_cast<std::size_t>(look.order)];
        out["enabled"] = look.is_enabled;
    }
    out["entries"] = entries_of(look);
    return out;
}

}  // namespace

Json entries_of(const darkroom::Look& look) {
    const std::vector<std::string> names = darkroom::entry_names(look);
    Json out = Json::array();
    for (const darkroom::LookEntry* const entry : darkroom::ordered(look)) {
        const darkroom::EffectInfo& effect = *entry->effect;
        Json values = Json::object();
        add_values(values, *entry);
        if (entry->state.opacity != 1) values["opacity"] = entry->state.opacity;
        const darkroom::EntryState plain;
        if (entry->state.blend != plain.blend)
            values["blend"] = Json::value_or_text(
                darkroom::format(*darkroom::entry_rows.find("blend"), darkroom::state_words(entry->state)));
        const bool is_on =
            entry->state.enabled.on != 0 && (effect.is_identity == nullptr || !effect.is_identity(entry->words.data()));
        if (look.is_flat && !is_on && values.empty()) continue;
        Json row{{"entry", names[static_cast<std::size_t>(entry - look.entries.data())]},
                 {"effect", effect.name},
                 {"is_on", is_on},
                 {"values", std::move(values)}};
        if (!entry->effect_file.empty()) row["file"] = entry->effect_file;
        if (Json wires = wires_of(*entry); !wires.empty()) row["wires"] = std::move(wires);
        out.push_back(std::move(row));
    }
    return out;
}

Result<Json> toml(const std::filesystem::path& path, bool allows_custom_effects,
                  darkroom::scene::NamedFiles named_files) {
    DARKROOM_TRY_VALUE(const std::string text, darkroom::scene::reading::read_scene_text(path));
    const std::string shown = path.string();
    DARKROOM_TRY_VALUE(const ::toml::table file, darkroom::parse_toml(text, shown));
    const bool is_scene = darkroom::scene::reading::is_scene(file), has_look = darkroom::scene::reading::has_look(file);
    if (!is_scene && !has_look)
        return darkroom::user_error(fmt::format(
            "{}: is neither a scene nor a look: it has no table [entities], [post_process] or [[stack]], nor any other "
            "of theirs",
            darkroom::printable(shown)));
    Json out{{"kind", is_scene ? "scene" : "look"}};
    if (is_scene) {
        DARKROOM_TRY_VALUE(const Json found, scene(text, path, named_files));
        out.update(found);
    }
    if (!has_look) return out;
    std::vector<std::string> warnings;
    DARKROOM_TRY_VALUE(const darkroom::Look look, darkroom::parse_look(text, shown,
                                                                       {.warnings = &warnings,
                                                                        .is_scene = is_scene,
                                                                        .allows_custom_effects = allows_custom_effects,
                                                                        .load_resource =
                                                                            [&](const auto& named, auto use) {
                                                                                return darkroom::load_resource_file(
                                                                                    named, use, warnings);
                                                                            },
                                                                        .folder = path.parent_path()}));
    if (is_scene)
        out["look"] = look_of(look);
    else
        out.update(look_of(look));
    for (std::string& warning : warnings) out["warnings"].push_back(std::move(warning));
    return out;
}

}  // namespace app::info
