// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <charconv>
#include <cmath>

#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

Transform local_transform(const Entity& entity, double time) {
    const std::vector<TransformKey>& path = entity.path;
    if (path.empty()) return entity.transform;
    const auto later = std::upper_bound(path.begin(), path.end(), time,
                                        [](double value, const TransformKey& key) { return value < key.time; });
    if (later == path.begin()) return path.front().transform;
    if (later == path.end()) return path.back().transform;
    const TransformKey& from = *(later - 1);
    const auto fraction = static_cast<float>((time - from.time) / (later->time - from.time));
    return {.position = glm::mix(from.transform.position, later->transform.position, fraction),
            .rotation = glm::normalize(glm::slerp(from.transform.rotation, later->transform.rotation, fraction)),
            .scale = glm::mix(from.transform.scale, later->transform.scale, fraction)};
}

/// From an entity up to its root; a parent met twice ends the chain.
std::vector<std::uint32_t> chain_of(const Scene& scene, std::uint32_t entity) {
    std::vector<std::uint32_t> chain;
    while (entity < scene.entities.size() && chain.size() < scene.entities.size()) {
        chain.push_back(entity);
        entity = scene.entities[entity].parent;
    }
    return chain;
}

}  // namespace

std::vector<mat4> entity_worlds(const Scene& scene, double time) {
    const std::size_t count = scene.entities.size();
    enum class State : std::uint8_t { Unknown, Waiting, Known };
    std::vector<State> states(count, State::Unknown);
    std::vector<mat4> worlds(count);
    std::vector<std::uint32_t> chain;
    for (std::uint32_t first = 0; first < count; ++first) {
        std::uint32_t entity = first;
        chain.clear();
        while (entity < count && states[entity] == State::Unknown) {
            states[entity] = State::Waiting;
            chain.push_back(entity);
            entity = scene.entities[entity].parent;
        }
        mat4 world = entity < count && states[entity] == State::Known ? worlds[entity] : mat4(1);
        for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
            world = world * local_transform(scene.entities[*link], time).matrix();
            worlds[*link] = world;
            states[*link] = State::Known;
        }
    }
    return worlds;
}

mat4 entity_world(const Scene& scene, std::uint32_t entity, double time) {
    const std::vector<std::uint32_t> chain = chain_of(scene, entity);
    mat4 world(1);
    for (auto link = chain.rbegin(); link != chain.rend(); ++link)
        world = world * local_transform(scene.entities[*link], time).matrix();
    return world;
}

bool is_moving(const Scene& scene, std::uint32_t entity) {
    for (const std::uint32_t link : chain_of(scene, entity))
        if (!scene.entities[link].path.empty()) return true;
    return false;
}

vec3 turned(const mat4& matrix, vec3 direction, vec3 fallback) {
    vec3 out(0);
    for (int axis = 0; axis < 3; ++axis) {
        const vec3 column(matrix[axis]);
        const float length = glm::length(column);
        if (length > 0) out += column * (direction[axis] / length);
    }
    const float length = glm::length(out);
    return length > 0 ? out / length : fallback;
}

const Pose& PoseCache::get(std::uint32_t model, std::uint32_t animation, double time) {
    const std::tuple key(model, animation, animation == no_index || !std::isfinite(time) ? 0.0 : time);
    const auto found = poses_.find(key);
    if (found != poses_.end()) return found->second;
    return poses_.emplace(key, pose(assets_.models[model], animation, std::get<2>(key), skins_)).first->second;
}

EntityAssets assets_of(const Assets& assets, std::uint32_t entity) {
    EntityAssets out = entity < assets.entities.size() ? assets.entities[entity] : EntityAssets{};
    if (out.model >= assets.models.size()) out.model = no_index;
    return out;
}

std::string place_of(const Scene& scene, const Entity& entity) {
    return entity.place.empty() ? scene.file.string() : entity.place;
}

std::uint32_t clip_of(const Scene& scene, std::uint32_t entity, const Model& model,
                      std::vector<std::string>* warnings) {
    const std::optional<ModelReference>& reference = scene.entities[entity].model;
    if (model.animations.empty() || (reference && !reference->is_animated)) return no_index;
    const std::string wanted = reference ? reference->animation : std::string();
    if (wanted.empty()) return 0;
    for (std::uint32_t i = 0; i < model.animations.size(); ++i)
        if (model.animations[i].name == wanted) return i;
    std::uint32_t number = 0;
    const auto [end, fault] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (fault == std::errc() && end == wanted.data() + wanted.size() && number < model.animations.size()) return number;
    if (warnings != nullptr) {
        constexpr std::size_t max_names = 20;
        std::string names;
        for (std::size_t i = 0; i < std::min(model.animations.size(), max_names); ++i)
            names += fmt::format(", \"{}\"", model.animations[i].name);
        if (model.animations.size() > max_names) names += ", ...";
        warnings->push_back(fmt::format(
            "{}: entities.{}.model: animation \"{}\" is not in the model, the first is played; it has 0 to {}{}",
            place_of(scene, scene.entities[entity]), scene.entities[entity].name, wanted, model.animations.size() - 1,
            names));
    }
    return 0;
}

}  // namespace darkroom::scene
