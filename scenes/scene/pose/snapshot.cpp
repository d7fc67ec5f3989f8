// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scene/pose/particles.hpp"
#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

constexpr float thinnest_box = 1e-6F;  // metres: a box without thickness has no normals

vec4 frame_rectangle(std::uint32_t frame, std::uint32_t frames_x, std::uint32_t frames_y) {
    const std::uint32_t columns = std::max(frames_x, 1U), rows = std::max(frames_y, 1U);
    const std::uint32_t column = frame % columns, row = frame / columns % rows;
    return {static_cast<float>(column) / static_cast<float>(columns),
            static_cast<float>(row) / static_cast<float>(rows),
            static_cast<float>(column + 1) / static_cast<float>(columns),
            static_cast<float>(row + 1) / static_cast<float>(rows)};
}

/// FNV-1a: an emitter's particles depend on its name, not on its place in the file.
std::uint64_t name_hash(std::string_view name) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    return hash;
}

bool is_mirroring(const mat4& matrix) { return glm::determinant(mat3(matrix)) < 0; }

class Builder {
  public:
    Builder(const Scene& scene, const Assets& assets, double time, double previous_time, PoseCache& poses)
        : scene_(scene), assets_(assets), time_(time), previous_time_(previous_time), poses_(poses) {
        worlds_ = entity_worlds(scene, time);
        const auto has_path = [](const Entity& entity) { return !entity.path.empty(); };
        const bool is_still =
            previous_time == time || std::none_of(scene.entities.begin(), scene.entities.end(), has_path);
        previous_worlds_ = is_still ? worlds_ : entity_worlds(scene, previous_time);
    }

    void add_visible(Snapshot& out) {
        out.instances.reserve(scene_.entities.size());
        out.materials.reserve(scene_.entities.size());
        for (std::uint32_t i = 0; i < scene_.entities.size(); ++i) {
            if (scene_.entities[i].bounds) add_box(i, out);
            if (assets_of(assets_, i).model != no_index) add_model(i, out);
            if (scene_.entities[i].sprite) add_sprite(i, out);
        }
    }

    void add_emitters(std::uint64_t seed, Snapshot& out) const {
        for (std::uint32_t i = 0; i < scene_.entities.size(); ++i) {
            const std::optional<ParticleEmitter>& emitter = scene_.entities[i].emitter;
            if (!emitter) continue;
            EmitterPath path = [world = worlds_[i]](double) { return world; };
            if (is_moving(scene_, i)) path = [this, i](double time) { return entity_world(scene_, i, time); };
            out.emitters.push_back({.image = assets_of(assets_, i).particle_texture,
                                    .blend = emitter->blend,
                                    .particles = particles(*emitter, path, seed ^ name_hash(scene_.entities[i].name),
                                                           time_, previous_time_)});
        }
    }

    [[nodiscard]] const std::vector<mat4>& worlds() const { return worlds_; }

  private:
    struct Poses {
        const Pose* now;
        const Pose* previous;
        std::uint32_t variant;
    };

    void add_box(std::uint32_t entity, Snapshot& out) const {
        const Box& box = *scene_.entities[entity].bounds;
        if (box.is_empty()) return;
        const mat4 to_box = glm::scale(glm::translate(mat4(1), box.low), glm::max(box.size(), vec3(thinnest_box)));
        BoxSurface surface = box_surface(scene_, assets_, entity);
        Instance instance{.world = worlds_[entity] * to_box,
                          .previous_world = previous_worlds_[entity] * to_box,
                          .material = static_cast<std::uint32_t>(out.materials.size()),
                          .entity = entity,
                          .is_wireframe = surface.is_wireframe,
                          .casts_shadow = !surface.is_wireframe && casts_shadow(surface.material)};
        instance.bounds = transformed({vec3(0), vec3(1)}, instance.world);
        instance.is_mirrored = is_mirroring(instance.world);
        out.instances.push_back(instance);
        out.materials.push_back(std::move(surface.material));
    }

    void add_model(std::uint32_t entity, Snapshot& out) {
        const std::uint32_t number = assets_of(assets_, entity).model;
        const Model& model = assets_.models[number];
        const std::uint32_t clip = clip_of(scene_, entity, model, &out.warnings);
        const std::optional<ModelReference>& reference = scene_.entities[entity].model;
        const double speed = reference ? static_cast<double>(reference->animation_speed) : 1;
        const double now = time_ * speed, before = motion_start(model, clip, now, previous_time_ * speed);
        const Poses poses{&poses_.get(number, clip, now), &poses_.get(number, clip, before),
                          reference ? variant_of(model, reference->variant) : no_index};
        std::vector<std::uint32_t> materials(model.materials.size() + 1, no_index);
        for (std::uint32_t node = 0; node < model.nodes.size(); ++node)
            if (model.nodes[node].mesh < model.meshes.size()) add_node(entity, number, node, poses, materials, out);
    }

    /// `materials`: numbers in the snapshot by those in the model; the last is the default material.
    void add_node(std::uint32_t entity, std::uint32_t number, std::uint32_t node, const Poses& poses,
                  std::vector<std::uint32_t>& materials, Snapshot& out) const {
        const Model& model = assets_.models[number];
        const std::uint32_t mesh = model.nodes[node].mesh;
        Instance instance{.mesh = {.model = number, .mesh = mesh},
                          .world = worlds_[entity] * poses.now->nodes[node],
                          .previous_world = previous_worlds_[entity] * poses.previous->nodes[node],
                          .entity = entity};
        const auto first_joint = static_cast<std::uint32_t>(out.joints.size());
        const std::uint32_t joint_count = add_joints(entity, model, node, poses, out);
        const auto first_weight = static_cast<std::uint32_t>(out.weights.size());
        const auto weight_count = static_cast<std::uint32_t>(poses.now->weights[node].size());
        out.weights.insert(out.weights.end(), poses.now->weights[node].begin(), poses.now->weights[node].end());
        out.previous_weights.insert(out.previous_weights.end(), poses.previous->weights[node].begin(),
                                    poses.previous->weights[node].end());
        const std::vector<Primitive>& primitives = model.meshes[mesh].primitives;
        for (std::uint32_t i = 0; i < primitives.size(); ++i) {
            const Primitive& primitive = primitives[i];
            const bool is_skinned = !primitive.skin.empty() && joint_count > 0;
            instance.mesh.primitive = i;
            instance.first_joint = is_skinned ? first_joint : no_index;
            instance.joint_count = is_skinned ? joint_count : 0;
            instance.weight_count = std::min(weight_count, static_cast<std::uint32_t>(primitive.targets.size()));
            instance.first_weight = instance.weight_count > 0 ? first_weight : no_index;
            instance.is_mirrored = is_mirroring(is_skinned ? out.joints[first_joint] : instance.world);
            instance.bounds = moved_bounds(primitive, instance, out);
            instance.material = surface_of(entity, material_of(primitive, poses.variant), materials, out);
            instance.casts_shadow = casts_shadow(out.materials[instance.material]);
            out.instances.push_back(instance);
        }
    }

    [[nodiscard]] std::uint32_t add_joints(std::uint32_t entity, const Model& model, std::uint32_t node,
                                           const Poses& poses, Snapshot& out) const {
        const Node& source = model.nodes[node];
        if (source.skin >= model.skins.size()) return 0;
        const std::vector<Primitive>& primitives = model.meshes[source.mesh].primitives;
        const auto is_skinned = [](const Primitive& primitive) { return !primitive.skin.empty(); };
        if (std::none_of(primitives.begin(), primitives.end(), is_skinned)) return 0;
        for (const mat4& joint : poses.now->joints[source.skin]) out.joints.push_back(worlds_[entity] * joint);
        for (const mat4& joint : poses.previous->joints[source.skin])
            out.previous_joints.push_back(previous_worlds_[entity] * joint);
        return static_cast<std::uint32_t>(poses.now->joints[source.skin].size());
    }

    [[nodiscard]] static Box moved_bounds(const Primitive& primitive, const Instance& instance, const Snapshot& out) {
        const auto joints =
            instance.joint_count == 0 ? std::span<const mat4>() : std::span(out.joints).subspan(instance.first_joint);
        const auto weights = instance.weight_count == 0
                                 ? std::span<const float>()
                                 : std::span(out.weights).subspan(instance.first_weight, instance.weight_count);
        const bool is_morphed = std::any_of(weights.begin(), weights.end(), [](float weight) { return weight != 0; });
        if (joints.empty() && !is_morphed) return transformed(primitive.bounds, instance.world);
        Box box;
        for (const vec3& point : deform(primitive, instance.world, joints, weights)) box.add(point);
        return box;
    }

    [[nodiscard]] std::uint32_t surface_of(std::uint32_t entity, std::uint32_t material,
                                           std::vector<std::uint32_t>& materials, Snapshot& out) const {
        std::uint32_t& number = materials[std::min<std::size_t>(material, materials.size() - 1)];
        if (number == no_index) {
            number = static_cast<std::uint32_t>(out.materials.size());
            out.materials.push_back(model_surface(scene_, assets_, entity, material));
        }
        return number;
    }

    void add_sprite(std::uint32_t entity, Snapshot& out) const {
        const Sprite& sprite = *scene_.entities[entity].sprite;
        if (!sprite.is_visible) return;
        const mat4& world = worlds_[entity];
        const vec2 scale(glm::length(vec3(world[0])), glm::length(vec3(world[1])));
        out.sprites.push_back({.image = assets_of(assets_, entity).sprite_texture,
                               .position = vec3(world[3]),
                               .previous_position = vec3(previous_worlds_[entity][3]),
                               .size = vec2(sprite.width, sprite.height) * scale,
                               .anchor_y = sprite.anchor_y,
                               .uv = frame_rectangle(sprite.frame, sprite.frames_x, sprite.frames_y),
                               .intensity = sprite.intensity});
    }

    const Scene& scene_;
    const Assets& assets_;
    double time_, previous_time_;
    PoseCache& poses_;
    std::vector<mat4> worlds_, previous_worlds_;
};

/// What a fitted view is fitted to: what is visible at the start, so that the view does not move with what it shows.
Box fitted_bounds(const Scene& scene, const Assets& assets, const Snapshot& now, PoseCache& poses) {
    if (now.time == 0) return scene_bounds(now);
    Snapshot start;
    Builder(scene, assets, 0, 0, poses).add_visible(start);
    return scene_bounds(start);
}

/// Places are floats: far from the origin they are so far apart that surfaces tear, and are speckled with shadows.
void warn_of_distance(const Scene& scene, const Box& fitted, Snapshot& out) {
    constexpr float finest = 1.0F / 1000;  // of its size, about a pixel
    const vec3 farthest = glm::max(glm::abs(fitted.low), glm::abs(fitted.high)), size = fitted.size();
    const float distance = std::max({farthest.x, farthest.y, farthest.z}), largest = std::max({size.x, size.y, size.z});
    const float step = std::nextafter(distance, std::numeric_limits<float>::infinity()) - distance;
    if (fitted.is_empty() || !(largest > 0) || step <= largest * finest) return;
    out.warnings.push_back(fmt::format(
        "{}: what is drawn is {:.3g} m large and lies {:.3g} m from the origin, where places are {:.2g} m apart; "
        "move it nearer",
        scene.file.string(), largest, distance, step));
}

}  // namespace

Snapshot snapshot(const Scene& scene, const Assets& assets, const SnapshotOptions& options) {
    Snapshot out{.time = options.time};
    PoseCache poses(scene, assets);
    Builder builder(scene, assets, options.time, options.previous_time, poses);
    builder.add_visible(out);
    add_lights(scene, assets, builder.worlds(), options.time, poses, out);
    const Box fitted = scene.camera.is_given ? Box{} : fitted_bounds(scene, assets, out, poses);
    warn_of_distance(scene, fitted, out);
    add_camera(scene, assets, options, fitted, poses, out);
    builder.add_emitters(options.seed, out);
    return out;
}

Box scene_bounds(const Snapshot& snapshot) {
    Box out;
    for (const Instance& instance : snapshot.instances)
        if (!instance.bounds.is_empty()) out.add(instance.bounds);
    for (const SpriteState& sprite : snapshot.sprites) {
        const vec3 middle = sprite.position + vec3(0, sprite.size.y * (0.5F - sprite.anchor_y), 0);
        const float reach = glm::length(sprite.size) * 0.5F;
        out.add({middle - reach, middle + reach});
    }
    for (const ParticleState& emitter : snapshot.emitters)
        for (const Particle& particle : emitter.particles) {
            const float reach = particle.size * 0.70710678F;  // a square's half diagonal
            out.add({particle.position - reach, particle.position + reach});
        }
    return out;
}

}  // namespace darkroom::scene
