// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <cmath>
#include <numeric>

#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

/// How many of a type the shaders have room for. Of directional lights the brightest are kept. Of the others those of
/// the largest intensity times range: that does not change when the camera moves, so that no light pops in or out.
struct Limit {
    LightType type;
    std::size_t most;
    const char* name;
};
constexpr std::array<Limit, 3> limits{
    {{LightType::Directional, 4, "directional"}, {LightType::Point, 16, "point"}, {LightType::Spot, 8, "spot"}}};

LightState state_of(const Light& light, std::string name, const mat4& world) {
    LightState out{.light = light, .name = std::move(name), .position = vec3(world[3])};
    if (!out.light.volumetric_color) out.light.volumetric_color = light.color;
    return out;
}

LightState entity_light(const Entity& entity, const mat4& world) {
    LightState out = state_of(*entity.light, entity.name, world);
    const vec3 given = out.light.direction;
    if (out.light.type == LightType::Directional)
        out.direction = turned(mat4(1), given, vec3(0, 1, 0));
    else
        out.direction = turned(world, given, vec3(0, -1, 0));
    return out;
}

/// KHR_lights_punctual: light goes out along -z of the node.
LightState model_light(const Light& light, std::string name, const mat4& world) {
    LightState out = state_of(light, std::move(name), world);
    const vec3 axis = turned(world, vec3(0, 0, -1), vec3(0, 0, -1));
    out.direction = light.type == LightType::Directional ? -axis : axis;
    return out;
}

void add_model_lights(const Entity& entity, const Model& model, const mat4& world, const Pose& pose,
                      std::vector<LightState>& out) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        if (node.light >= model.lights.size()) continue;
        const std::string part = node.name.empty() ? fmt::format("node {}", i) : node.name;
        out.push_back(
            model_light(model.lights[node.light], fmt::format("{}/{}", entity.name, part), world * pose.nodes[i]));
        out.back().light.intensity *= entity.model.value_or(ModelReference{}).light_scale;
    }
}

void add_default_lights(std::vector<LightState>& out) {
    const Light key{.color = {1, 0.98F, 0.95F}, .intensity = 3, .direction = {0.5F, 1, 0.3F}};
    const Light fill{.color = {0.6F, 0.7F, 0.9F}, .intensity = 0.8F, .direction = {-0.4F, -0.3F, -0.6F}};
    for (const auto& [light, name] : {std::pair(key, "key"), std::pair(fill, "fill")}) {
        out.push_back(state_of(light, name, mat4(1)));
        out.back().direction = glm::normalize(light.direction);
    }
}

float reach(const LightState& state) {
    return state.light.type == LightType::Directional ? state.light.intensity
                                                      : state.light.intensity * state.light.range;
}

/// The entity that a light is of, by its name: "entity", or "entity/node" of a model.
const Entity* owner_of(const LightState& light, const Scene& scene) {
    for (const std::string& name : {light.name, light.name.substr(0, light.name.rfind('/'))})
        for (const Entity& entity : scene.entities)
            if (entity.name == name) return &entity;
    return nullptr;
}

/// Takes out what is beyond the limit of a type and keeps the order of the rest.
void limit(std::vector<LightState>& lights, const Limit& limit, const Scene& scene,
           std::vector<std::string>& warnings) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (lights[i].light.type == limit.type) order.push_back(i);
    if (order.size() <= limit.most) return;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return reach(lights[a]) > reach(lights[b]); });
    const LightState& first = lights[order[limit.most]];
    const Entity* const owner = owner_of(first, scene);
    warnings.push_back(
        fmt::format("{}: {} {} lights, of which {} are left out, entities.{} first; at most {} are drawn",
                    owner == nullptr ? scene.file.string() : place_of(scene, *owner), order.size(), limit.name,
                    order.size() - limit.most, first.name, limit.most));
    std::vector<bool> is_left_out(lights.size());
    for (std::size_t i = limit.most; i < order.size(); ++i) is_left_out[order[i]] = true;
    std::size_t next = 0;
    std::erase_if(lights, [&](const LightState&) { return is_left_out[next++]; });
}

bool goes_before(const LightState& a, const LightState& b) {
    const bool is_directional = a.light.type == LightType::Directional;
    if (is_directional != (b.light.type == LightType::Directional)) return is_directional;
    if (!is_directional) return false;
    return a.light.intensity != b.light.intensity ? a.light.intensity > b.light.intensity : a.name < b.name;
}

}  // namespace

void add_lights(const Scene& scene, const Assets& assets, const std::vector<mat4>& worlds, double time,
                PoseCache& poses, Snapshot& out) {
    for (std::uint32_t i = 0; i < scene.entities.size(); ++i) {
        const Entity& entity = scene.entities[i];
        if (entity.light) out.lights.push_back(entity_light(entity, worlds[i]));
        const EntityAssets own = assets_of(assets, i);
        if (own.model == no_index || assets.models[own.model].lights.empty()) continue;
        const Model& model = assets.models[own.model];
        const float speed = entity.model ? entity.model->animation_speed : 1;
        const Pose& pose = poses.get(own.model, clip_of(scene, i, model, nullptr), time * static_cast<double>(speed));
        add_model_lights(entity, model, worlds[i], pose, out.lights);
    }
    if (out.lights.empty()) add_default_lights(out.lights);
    // Before the limits: of equally bright directional lights the first names are kept.
    std::stable_sort(out.lights.begin(), out.lights.end(), goes_before);
    for (const Limit& type : limits) limit(out.lights, type, scene, out.warnings);
}

}  // namespace darkroom::scene
