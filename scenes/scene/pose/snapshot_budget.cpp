// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <set>

#include "image/codec/decoder.hpp"
#include "scene/pose/particles.hpp"
#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

// What one of each takes: in the snapshots of the start and of now, in the lists of what is drawn, and as the device
// gets it, once for the view and again for the cascades that it casts a shadow into.
constexpr std::uint64_t instance_size = 1024, material_size = 512, joint_size = 6 * sizeof(mat4), weight_size = 32;
constexpr std::uint64_t node_size = 4 * sizeof(mat4), light_size = 256, sprite_size = 256, particle_size = 256;

// What going through one costs, in the bytes that are converted meanwhile: a vertex that is moved for its bounds, a
// triangle for the view, a parent, and the births that an emitter looks back at.
constexpr std::uint64_t vertex_work = 32, triangle_work = 4, parent_work = 8, emitter_work = 1U << 19U;

/// What an entity that draws the model adds to a snapshot.
struct Counts {
    std::uint64_t instances = 0, joints = 0, weights = 0, moved_vertices = 0, triangles = 0, lights = 0, materials = 0;

    Counts& operator+=(const Counts& other) {
        for (std::uint64_t Counts::*count : {&Counts::instances, &Counts::joints, &Counts::weights,
                                             &Counts::moved_vertices, &Counts::triangles, &Counts::lights})
            this->*count += other.*count;
        return *this;
    }
};

struct MeshCounts {
    Counts still, skinned;  ///< of a node without and with a skin, whose joints are not in it
};

MeshCounts count(const Mesh& mesh) {
    MeshCounts out;
    std::uint64_t targets = mesh.weights.size();
    for (const Primitive& primitive : mesh.primitives) {
        const std::uint64_t vertices = primitive.vertices.size(), own = primitive.targets.size();
        targets = std::max(targets, own);
        out.still.triangles += primitive.indices.size() / 3;
        out.still.moved_vertices += own == 0 ? 0 : vertices * (own + 1);
        out.skinned.moved_vertices += primitive.skin.empty() && own == 0 ? 0 : vertices * (own + 1);
    }
    out.still.instances = mesh.primitives.size();
    out.still.weights = targets;
    const std::uint64_t moved = out.skinned.moved_vertices;
    out.skinned = out.still;
    out.skinned.moved_vertices = moved;
    return out;
}

Counts count(const Model& model) {
    std::vector<MeshCounts> meshes;
    for (const Mesh& mesh : model.meshes) meshes.push_back(count(mesh));
    Counts out;
    for (const Node& node : model.nodes) {
        if (node.light < model.lights.size()) ++out.lights;
        if (node.mesh >= meshes.size()) continue;
        const bool is_skinned = node.skin < model.skins.size();
        out += is_skinned ? meshes[node.mesh].skinned : meshes[node.mesh].still;
        if (is_skinned) out.joints += model.skins[node.skin].joints.size();
    }
    out.materials = std::min<std::uint64_t>(model.materials.size() + 1, out.instances);
    return out;
}

std::uint64_t joints_of_skins(const Model& model) {
    std::uint64_t joints = 0;
    for (const Skin& skin : model.skins) joints += skin.joints.size();
    return joints;
}

/// How many entities hang above each.
std::vector<std::uint64_t> depths(const Scene& scene) {
    std::vector<std::uint64_t> out(scene.entities.size(), 0);
    std::vector<bool> is_known(out.size());
    std::vector<std::uint32_t> walk;
    for (std::uint32_t start = 0; start < out.size(); ++start) {
        std::uint32_t at = start;
        for (; at < out.size() && !is_known[at]; at = scene.entities[at].parent) {
            is_known[at] = true;
            walk.push_back(at);
        }
        std::uint64_t depth = at < out.size() ? out[at] + 1 : 0;
        for (; !walk.empty(); walk.pop_back()) out[walk.back()] = depth++;
    }
    return out;
}

std::string shown_variants(const Model& model) {
    constexpr std::size_t max_names = 20;
    if (model.variants.empty()) return "the model has no variants";
    std::string names;
    for (std::size_t i = 0; i < std::min(model.variants.size(), max_names); ++i)
        names += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", model.variants[i]);
    return fmt::format("allowed is {}{}", names, model.variants.size() > max_names ? ", ..." : "");
}

class Check {
  public:
    Check(const Scene& scene, const Assets& assets) : scene_(scene), assets_(assets), budget_(scene.file_bytes) {
        for (const Model& model : assets.models) {
            budget_.add_file(model.file_bytes);
            models_.push_back(count(model));
        }
    }

    Result<> run() {
        const std::vector<std::uint64_t> parents = depths(scene_);
        for (std::uint32_t i = 0; i < scene_.entities.size(); ++i) {
            const Entity& entity = scene_.entities[i];
            place_ = fmt::format("{}: entities.{}", place_of(scene_, entity), entity.name);
            if (entity.bounds) take("boxes", 1, instance_size + material_size);
            if (entity.light) take("lights", 1, light_size);
            if (entity.sprite) take("sprites", 1, sprite_size);
            if (entity.emitter) {
                const std::uint64_t particles = std::min(entity.emitter->max_particles, max_particles);
                take("particles", particles, particle_size);
                work("emitters", 1, emitter_work);
                work("particles with parents", particles * parents[i], parent_work);
            }
            if (const std::uint32_t model = assets_of(assets_, i).model; model != no_index)
                take_model(entity, model, parents[i]);
            if (unknown_variant_) return user_error(*unknown_variant_);
            DARKROOM_TRY(budget_.check());
        }
        return {};
    }

  private:
    // Refusals are looked at once an entity.
    void take(std::string_view things, std::uint64_t count, std::uint64_t size) {
        static_cast<void>(budget_.take(place_, things, count, size));
    }
    void work(std::string_view things, std::uint64_t count, std::uint64_t size) {
        static_cast<void>(budget_.work(place_, things, count, size));
    }

    void take_model(const Entity& entity, std::uint32_t number, std::uint64_t parents) {
        const Model& model = assets_.models[number];
        const Counts& counts = models_[number];
        const ModelReference reference = entity.model.value_or(ModelReference{});
        if (!reference.variant.empty()) work("variants", model.variants.size(), sizeof(std::string));
        if (!reference.variant.empty() && variant_of(model, reference.variant) == no_index && !unknown_variant_)
            unknown_variant_ = fmt::format("{}.model.variant = \"{}\": {}", place_,
                                           one_printable_line(reference.variant), shown_variants(model));
        if (poses_.emplace(number, reference.animation, reference.is_animated, reference.animation_speed).second) {
            take("nodes", model.nodes.size(), node_size);
            take("joints", joints_of_skins(model), 2 * sizeof(mat4));
        } else {
            work("nodes", model.nodes.size(), node_size);
        }
        take("instances", counts.instances, instance_size);
        take("materials", counts.materials, material_size);
        take("joints of nodes", counts.joints, joint_size);
        take("weights of morph targets", counts.weights, weight_size);
        take("lights", counts.lights, light_size);
        work("vertices of skins and morph targets", counts.moved_vertices, vertex_work);
        work("triangles", counts.triangles, triangle_work);
        work("materials with parents", counts.materials * parents, parent_work);
        work("animations", model.animations.size(), sizeof(Animation));
    }

    const Scene& scene_;
    const Assets& assets_;
    Budget budget_;
    std::vector<Counts> models_;
    std::set<std::tuple<std::uint32_t, std::string, bool, float>> poses_;
    std::string place_;
    std::optional<std::string> unknown_variant_;
};

}  // namespace

Result<> check_snapshot(const Scene& scene, const Assets& assets) {
    return assets.machine_error ? failure(*assets.machine_error) : Check(scene, assets).run();
}

}  // namespace darkroom::scene
