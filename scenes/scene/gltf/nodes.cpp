// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/gltf/convert.hpp"

namespace darkroom::scene::gltf {
namespace {

// A light without a range reaches everywhere; this is as far as any scene goes, in metres.
constexpr float endless_range = 1e4F;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Nodes of a faulty element have no children: it was replaced. What is faulty is judged where it is needed.
Result<std::vector<std::uint32_t>> find_parents(const tinygltf::Model& model) {
    std::vector<std::uint32_t> parents(model.nodes.size(), no_index);
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children) {
            std::uint32_t& parent = parents[at(child)];
            if (parent != no_index)
                return user_error(
                    fmt::format("/nodes/{}/children: node {} is a child of node {} already", node, child, parent));
            parent = static_cast<std::uint32_t>(node);
        }
    return parents;
}

std::string shown_cycle(const std::vector<std::uint32_t>& parents, std::uint32_t start) {
    std::vector<std::uint32_t> cycle{start};
    for (std::uint32_t node = parents[start]; node != start; node = parents[node]) cycle.push_back(node);
    std::reverse(cycle.begin() + 1, cycle.end());
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(cycle.size(), 16); ++i) text += fmt::format("{} -> ", cycle[i]);
    if (cycle.size() > 16) text += "... -> ";
    return text + std::to_string(start);
}

Result<> refuse_cycles(const std::vector<std::uint32_t>& parents) {
    // Every walk upwards is marked with its start; meeting the own mark is a cycle, another's a known way out.
    std::vector<std::uint32_t> mark(parents.size(), no_index);
    for (std::uint32_t start = 0; start < parents.size(); ++start)
        for (std::uint32_t node = start; node != no_index; node = parents[node]) {
            if (mark[node] == start)
                return user_error(fmt::format("/nodes/{}/children: node cycle {}", node, shown_cycle(parents, node)));
            if (mark[node] != no_index) break;
            mark[node] = start;
        }
    return {};
}

// The topmost node above each; there are no cycles.
std::vector<std::uint32_t> find_roots(const std::vector<std::uint32_t>& parents) {
    std::vector<std::uint32_t> roots(parents.size(), no_index);
    std::vector<std::uint32_t> path;
    for (std::uint32_t start = 0; start < parents.size(); ++start) {
        std::uint32_t node = start;
        for (path.clear(); roots[node] == no_index && parents[node] != no_index; node = parents[node])
            path.push_back(node);
        const std::uint32_t root = roots[node] == no_index ? node : roots[node];
        roots[node] = root;
        for (const std::uint32_t below : path) roots[below] = root;
    }
    return roots;
}

}  // namespace

Result<NodeOrder> order_nodes(Document& document) {
    const tinygltf::Model& model = document.model();
    DARKROOM_TRY_VALUE(auto parents, find_parents(model));
    DARKROOM_TRY(refuse_cycles(parents));

    std::vector<int> roots;
    if (model.scenes.empty()) {
        for (std::size_t node = 0; node < model.nodes.size(); ++node)
            if (parents[node] == no_index) roots.push_back(static_cast<int>(node));
    } else {
        const std::size_t scene = model.defaultScene < 0 ? 0 : at(model.defaultScene);
        DARKROOM_TRY(document.faults().check(fmt::format("/scenes/{}", scene)));
        roots = model.scenes[scene].nodes;
        for (const int root : roots)
            if (parents[at(root)] != no_index)
                return user_error(
                    fmt::format("/scenes/{}/nodes: node {} is a child of node {}", scene, root, parents[at(root)]));
    }

    NodeOrder order{.root = find_roots(parents)};
    order.new_index.assign(model.nodes.size(), no_index);
    std::vector<int> open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        DARKROOM_TRY(document.faults().check(fmt::format("/nodes/{}", node)));
        if (order.new_index[at(node)] != no_index) return user_error(fmt::format("/scenes: node {} twice", node));
        const std::uint32_t parent = parents[at(node)];
        order.new_index[at(node)] = static_cast<std::uint32_t>(order.file_index.size());
        order.file_index.push_back(static_cast<std::uint32_t>(node));
        order.parent.push_back(parent == no_index ? no_index : order.new_index[parent]);
        const std::vector<int>& children = model.nodes[at(node)].children;
        open.insert(open.end(), children.rbegin(), children.rend());
    }
    return order;
}

Node convert_node(Document& document, std::uint32_t file_index, std::uint32_t parent) {
    const tinygltf::Node& source = document.model().nodes[file_index];
    const std::string pointer = fmt::format("/nodes/{}", file_index);
    Node node{.name = source.name, .parent = parent};
    const auto index = [](int value) { return value < 0 ? no_index : static_cast<std::uint32_t>(value); };
    node.mesh = index(source.mesh);
    node.skin = index(source.skin);
    node.camera = index(source.camera);
    if (const auto found = source.extensions.find("KHR_lights_punctual"); found != source.extensions.end())
        node.light = index(static_cast<int>(number_of(found->second, "light", -1)));
    for (const double weight : source.weights) node.weights.push_back(as_float(weight));

    if (source.matrix.size() == 16) {
        mat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = as_float(source.matrix[at(i)]);
        if (std::abs(glm::determinant(mat3(matrix))) < 1e-30F)
            document.faults().warn(fmt::format("{}/matrix: flattens what it is applied to", pointer));
        if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1) {
            document.faults().warn(
                fmt::format("{}/matrix: the last row is not 0 0 0 1, and is taken as that", pointer));
            for (int c = 0; c < 4; ++c) matrix[c][3] = c == 3 ? 1.0F : 0.0F;
        }
        node.matrix = matrix;
        return node;
    }
    for (int c = 0; c < 3; ++c) {
        if (source.translation.size() == 3) node.transform.position[c] = as_float(source.translation[at(c)]);
        if (source.scale.size() == 3) node.transform.scale[c] = as_float(source.scale[at(c)]);
    }
    if (source.rotation.size() == 4) {
        const quat rotation(as_float(source.rotation[3]), as_float(source.rotation[0]), as_float(source.rotation[1]),
                            as_float(source.rotation[2]));
        const float length = glm::length(rotation);
        if (std::abs(length - 1) > 0.005F)
            document.faults().warn(fmt::format("{}/rotation: length {}, 1 is needed", pointer, length));
        node.transform.rotation = length > 1e-6F ? rotation / length : quat(1, 0, 0, 0);
    }
    return node;
}

Result<Skin> convert_skin(Document& document, std::size_t index, const NodeOrder& order) {
    const std::string pointer = fmt::format("/skins/{}", index);
    DARKROOM_TRY(document.faults().check(pointer));
    const tinygltf::Skin& source = document.model().skins[index];
    if (source.joints.empty()) return user_error(fmt::format("{}/joints: is empty", pointer));
    // Joints must hang together (glTF 2.0 specification, 3.7.3.2), which drawing them does not need.
    for (const int joint : source.joints)
        if (order.root[at(joint)] != order.root[at(source.joints.front())])
            document.faults().warn(fmt::format("{}/joints: have no common root", pointer));
    DARKROOM_TRY(document.budget().take(pointer, "joints", source.joints.size(), 2 * sizeof(mat4)));
    Skin skin;
    std::vector<bool> is_joint(order.file_index.size());
    for (const int joint : source.joints) {
        const std::uint32_t node = order.new_index[at(joint)];
        if (node == no_index) return user_error(fmt::format("{}/joints: node {} is not in the scene", pointer, joint));
        if (is_joint[node]) document.faults().warn(fmt::format("{}/joints: node {} twice", pointer, joint));
        is_joint[node] = true;
        skin.joints.push_back(node);
    }
    // glTF 2.0 specification, 3.7.3.2: without matrices they are the identity.
    skin.inverse_bind.assign(skin.joints.size(), mat4(1));
    if (source.inverseBindMatrices < 0) return skin;
    const std::string place = fmt::format("{}/inverseBindMatrices", pointer);
    DARKROOM_TRY_VALUE(auto layout, document.layout(source.inverseBindMatrices));
    const Layout& shape = *layout;
    if (shape.components != 16 || shape.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT)
        return user_error(fmt::format("{}: accessor {} is not MAT4 of floats", place, source.inverseBindMatrices));
    if (shape.count < skin.joints.size())
        return user_error(fmt::format("{}: accessor {} has {} matrices for {} joints", place,
                                      source.inverseBindMatrices, shape.count, skin.joints.size()));
    DARKROOM_TRY_VALUE(auto numbers, document.numbers(source.inverseBindMatrices));
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        mat4& matrix = skin.inverse_bind[i];
        for (int c = 0; c < 16; ++c) matrix[c / 4][c % 4] = numbers.values[i * 16 + at(c)];
        for (int c = 0; c < 16; ++c)
            if (!std::isfinite(matrix[c / 4][c % 4]))
                return user_error(fmt::format("{}: matrix {} is not finite", place, i));
        const bool is_affine = matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
        if (is_affine) continue;
        document.faults().warn(fmt::format("{}: the last row of matrix {} is not 0 0 0 1", place, i));
        for (int c = 0; c < 4; ++c) matrix[c][3] = c == 3 ? 1.0F : 0.0F;
    }
    return skin;
}

ModelCamera convert_camera(Document& document, std::size_t index) {
    const std::string pointer = fmt::format("/cameras/{}", index);
    const tinygltf::Camera& source = document.model().cameras[index];
    ModelCamera camera{.name = source.name};
    const bool is_orthographic = source.type == "orthographic";
    camera.near_distance = as_float(is_orthographic ? source.orthographic.znear : source.perspective.znear);
    const float far_distance = as_float(is_orthographic ? source.orthographic.zfar : source.perspective.zfar);
    if (is_orthographic) {
        camera.projection = Projection::Orthographic;
        camera.ortho_height = 2 * std::abs(as_float(source.orthographic.ymag));
    } else {
        camera.field_of_view = as_float(source.perspective.yfov * 180 / std::numbers::pi);
    }
    // Perspective cameras may leave the far plane out: it is at infinity.
    const float otherwise = is_orthographic ? camera.near_distance + 1000 : std::numeric_limits<float>::infinity();
    camera.far_distance = far_distance > 0 ? far_distance : otherwise;
    const bool is_good =
        camera.near_distance >= 0 && camera.far_distance > camera.near_distance &&
        (is_orthographic ? camera.ortho_height > 0
                         : camera.near_distance > 0 && camera.field_of_view > 0 && camera.field_of_view < 180);
    if (is_good) return camera;
    document.faults().warn(fmt::format("{}: znear {}, zfar {} and the angle or height make no view", pointer,
                                       camera.near_distance, camera.far_distance));
    return {.name = source.name};
}

Light convert_light(Document& document, std::size_t index) {
    const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
    const tinygltf::Light& source = document.model().lights[index];
    Light light;
    for (std::size_t c = 0; c < 3 && c < source.color.size(); ++c)
        light.color[static_cast<int>(c)] = as_float(source.color[c]);
    light.intensity = std::max(as_float(source.intensity), 0.0F);
    light.range = source.range > 0 ? as_float(source.range) : endless_range;
    // Lights of glTF shine along their node's -z.
    if (source.type == "directional") {
        light.type = LightType::Directional;
        light.direction = {0, 0, 1};
        return light;
    }
    light.type = source.type == "spot" ? LightType::Spot : LightType::Point;
    light.direction = {0, 0, -1};
    if (light.type == LightType::Point) return light;
    light.inner_angle = as_float(source.spot.innerConeAngle);
    light.outer_angle = as_float(source.spot.outerConeAngle);
    if (!(light.inner_angle < light.outer_angle)) {
        document.faults().warn(fmt::format("{}/spot: inner angle {} is not below the outer, {}", pointer,
                                           light.inner_angle, light.outer_angle));
        light.inner_angle = std::max(0.0F, light.outer_angle - 0.01F);
    }
    return light;
}

}  // namespace darkroom::scene::gltf
