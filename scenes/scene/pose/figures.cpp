// SPDX-License-Identifier: MIT
#include "scene/pose/figures.hpp"

#include <fmt/format.h>

#include "image/codec/decoder.hpp"
#include "scene/pose/snapshot_parts.hpp"

namespace darkroom::scene {

namespace {

// Of the pose of the file. A mesh that many nodes draw counts once: nodes may be many more than vertices.
Box figure_bounds(const Model& model, const mat4& world, Skins skins) {
    const Pose at_rest = pose(model, no_index, 0, skins);
    std::vector<bool> is_done(model.meshes.size());
    Box out;
    for (const Node& node : model.nodes) {
        if (node.mesh >= model.meshes.size() || node.skin >= model.skins.size() || is_done[node.mesh]) continue;
        is_done[node.mesh] = true;
        std::vector<mat4> joints;
        for (const mat4& joint : at_rest.joints[node.skin]) joints.push_back(world * joint);
        for (const Primitive& primitive : model.meshes[node.mesh].primitives) {
            if (primitive.skin.empty()) continue;
            for (const vec3& point : deform(primitive, world, joints, {})) out.add(point);
        }
    }
    return out;
}

bool differ(const Box& a, const Box& b) {
    constexpr float least_change = 0.01F;  // of the larger: what would be seen
    for (int axis = 0; axis < 3; ++axis) {
        const float first = a.size()[axis], second = b.size()[axis];
        if (std::abs(first - second) > least_change * std::max(first, second)) return true;
    }
    return false;
}

}  // namespace

std::vector<std::string> figure_notices(const Scene& scene, const Assets& assets) {
    std::vector<std::string> notices;
    if (!scene.has_assumed_skins) return notices;
    std::vector<bool> is_done(assets.models.size());
    for (std::uint32_t i = 0; i < scene.entities.size(); ++i) {
        const std::uint32_t number = assets_of(assets, i).model;
        if (number == no_index || is_done[number]) continue;
        is_done[number] = true;
        const Model& model = assets.models[number];
        const mat4 world = entity_world(scene, i, 0);
        const Box by_joints = figure_bounds(model, world, Skins::JointsOnly);
        const Box by_all = figure_bounds(model, world, Skins::AllNodes);
        if (by_joints.is_empty() || by_all.is_empty() || !differ(by_joints, by_all)) continue;
        notices.push_back(
            fmt::format("{}: entities.{}.model: the figure is {:.3g} m high by its joints alone, for which scenes of "
                        "this style are placed; skins = \"all_nodes\" in [scene] makes it {:.3g} m",
                        place_of(scene, scene.entities[i]), one_printable_line(scene.entities[i].name),
                        by_joints.size().y, by_all.size().y));
    }
    return notices;
}

}  // namespace darkroom::scene
