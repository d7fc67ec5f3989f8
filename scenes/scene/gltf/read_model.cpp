// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "image/codec/decoder.hpp"
#include "scene/gltf/convert.hpp"
#include "scene/mesh/geometry.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

using gltf::Document;
using gltf::NodeOrder;

/// Converts all of one kind. What the scene needs must be good; the rest is replaced by an empty one.
template <class T, class Convert>
Result<> convert_all(Document& document, std::size_t count, const std::vector<bool>& is_needed, const Convert& convert,
                     std::vector<T>& out) {
    for (std::size_t i = 0; i < count; ++i) {
        Result<T> made = convert(i);
        if (!made && is_needed[i]) return failure(std::move(made));
        if (!made) {
            document.faults().warn(fmt::format("{} (not drawn)", made.error().text));
            made = T();
        }
        out.push_back(std::move(*made));
    }
    return {};
}

std::vector<bool> needed(std::size_t count, const std::vector<Node>& nodes, std::uint32_t Node::*index) {
    std::vector<bool> is_needed(count);
    for (const Node& node : nodes)
        if (node.*index != no_index) is_needed[node.*index] = true;
    return is_needed;
}

bool has_tangents(const Primitive& primitive) {
    return std::ranges::any_of(primitive.vertices, [](const Vertex& vertex) { return vertex.tangent != vec4(0); });
}

// Of the surface or its coat.
const Texture& normal_texture_of(const ModelMaterial& material) {
    return material.normal_texture.is_given() ? material.normal_texture : material.clearcoat.normal_texture;
}

// Of the material, or of the first variant that has one.
Texture normal_texture_of(const Model& model, const Primitive& primitive) {
    Texture texture;
    if (primitive.material != no_index) texture = normal_texture_of(model.materials[primitive.material]);
    for (const VariantMaterial& variant : primitive.variants)
        if (!texture.is_given()) texture = normal_texture_of(model.materials[variant.material]);
    return texture;
}

void read_variant_names(const tinygltf::Model& source, std::vector<std::string>& names) {
    const auto found = source.extensions.find("KHR_materials_variants");
    if (found == source.extensions.end()) return;
    const tinygltf::Value& variants = found->second.Get("variants");
    for (int i = 0; i < static_cast<int>(variants.ArrayLen()); ++i)
        names.push_back(one_printable_line(variants.Get(i).Get("name").Get<std::string>()));
}

// glTF 2.0, 3.7.2.1: for the coordinates of the normal map. Without one nothing reads them.
Result<> make_missing_tangents(Document& document, Model& model) {
    for (std::size_t i = 0; i < model.meshes.size(); ++i)
        for (Primitive& primitive : model.meshes[i].primitives) {
            if (has_tangents(primitive)) continue;
            const Texture texture = normal_texture_of(model, primitive);
            if (!texture.is_given()) continue;
            const std::string place = fmt::format("/meshes/{}", i);
            const std::uint64_t taken = document.budget().taken();
            const std::size_t before = size_in_memory(primitive);
            DARKROOM_TRY(document.budget().take(place, "vertices with tangents", primitive.vertices.size(),
                                                tangent_bytes_per_vertex(primitive)));
            DARKROOM_TRY(document.budget().take(place, "corners with tangents", primitive.indices.size(),
                                                tangent_bytes_per_corner));
            make_tangents(primitive, texture);
            document.budget().give_back_to(taken);
            DARKROOM_TRY(document.budget().take(place, "bytes", size_in_memory(primitive) - before, 1));
        }
    return {};
}

Result<> convert_drawn(Document& document, const NodeOrder& order, Model& model) {
    const tinygltf::Model& source = document.model();
    DARKROOM_TRY(convert_all(
        document, source.meshes.size(), needed(source.meshes.size(), model.nodes, &Node::mesh),
        [&](std::size_t i) { return convert_mesh(document, i); }, model.meshes));
    std::vector<bool> is_material_needed(source.materials.size());
    const std::vector<bool> is_mesh_needed = needed(source.meshes.size(), model.nodes, &Node::mesh);
    for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh)
        for (const Primitive& primitive : model.meshes[mesh].primitives) {
            if (!is_mesh_needed[mesh]) continue;
            if (primitive.material != no_index) is_material_needed[primitive.material] = true;
            for (const VariantMaterial& variant : primitive.variants) is_material_needed[variant.material] = true;
        }
    DARKROOM_TRY_VALUE(model.images, convert_images(document));
    std::vector<bool> is_broken;
    for (const Image& image : model.images) is_broken.push_back(image.is_empty());
    DARKROOM_TRY(convert_all(
        document, source.materials.size(), is_material_needed,
        [&](std::size_t i) { return convert_material(document, i, is_broken); }, model.materials));
    DARKROOM_TRY(make_missing_tangents(document, model));
    return convert_all(
        document, source.skins.size(), needed(source.skins.size(), model.nodes, &Node::skin),
        [&](std::size_t i) { return convert_skin(document, i, order); }, model.skins);
}

// Cameras and lights do not depend on anything else, and animations only move what is drawn: a faulty one is left out.
Result<> convert_rest(Document& document, const NodeOrder& order, Model& model) {
    const tinygltf::Model& source = document.model();
    for (std::size_t i = 0; i < source.cameras.size(); ++i) model.cameras.push_back(convert_camera(document, i));
    for (Node& node : model.nodes)
        if (node.camera != no_index && !document.faults().check(fmt::format("/cameras/{}", node.camera)))
            node.camera = no_index;
    const std::vector<bool> is_light_needed = needed(source.lights.size(), model.nodes, &Node::light);
    for (std::size_t i = 0; i < source.lights.size(); ++i) {
        const auto checked = document.faults().check(fmt::format("/extensions/KHR_lights_punctual/lights/{}", i));
        if (!checked && is_light_needed[i]) return user_error(checked.error().text);
        model.lights.push_back(convert_light(document, i));
    }
    for (std::size_t i = 0; i < source.animations.size(); ++i) {
        auto animation = convert_animation(document, i, order, model);
        if (animation)
            model.animations.push_back(std::move(*animation));
        else
            document.faults().warn(fmt::format("{}; the animation is left out", animation.error().text));
    }
    return {};
}

// Of a mesh that many nodes may draw, each with another skin: the highest joint that it names.
std::uint32_t highest_joint(const Mesh& mesh) {
    std::uint32_t highest = 0;
    for (const Primitive& primitive : mesh.primitives)
        for (const VertexSkin& vertex : primitive.skin)
            for (const std::uint16_t joint : vertex.joints) highest = std::max<std::uint32_t>(highest, joint);
    return highest;
}

// What only nodes, meshes and skins together tell.
Result<> check_nodes(Document& document, const NodeOrder& order, Model& model) {
    std::vector<std::uint32_t> highest_joints;
    for (const Mesh& mesh : model.meshes) highest_joints.push_back(highest_joint(mesh));
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        Node& node = model.nodes[i];
        const std::string pointer = fmt::format("/nodes/{}", order.file_index[i]);
        const Mesh* mesh = node.mesh == no_index ? nullptr : &model.meshes[node.mesh];
        if (!node.weights.empty() && (mesh == nullptr || node.weights.size() != mesh->weights.size())) {
            document.faults().warn(fmt::format("{}/weights: {} numbers for {} morph targets", pointer,
                                               node.weights.size(), mesh == nullptr ? 0 : mesh->weights.size()));
            node.weights.resize(mesh == nullptr ? 0 : mesh->weights.size());
        }
        if (node.skin == no_index) continue;
        if (mesh == nullptr) {
            document.faults().warn(fmt::format("{}/skin: the node has no mesh", pointer));
            continue;
        }
        const std::size_t joint_count = model.skins[node.skin].joints.size();
        const auto has_no_skin = [](const Primitive& primitive) { return primitive.skin.empty(); };
        const bool is_skinned = !std::ranges::all_of(mesh->primitives, has_no_skin);
        if (std::ranges::any_of(mesh->primitives, has_no_skin))
            document.faults().warn(fmt::format("{}/skin: a primitive of mesh {} has no joints", pointer, node.mesh));
        if (is_skinned && highest_joints[node.mesh] >= joint_count)
            return user_error(fmt::format("{}/skin: mesh {} names joint {}, skin {} has {}", pointer, node.mesh,
                                          highest_joints[node.mesh], node.skin, joint_count));
    }
    return {};
}

Result<Model> read(const std::filesystem::path& path, Budget budget, NamedFiles named_files) {
    DARKROOM_TRY_VALUE(auto document, Document::open(path, std::move(budget), named_files));
    DARKROOM_TRY_VALUE(auto order, order_nodes(document));
    Model model{.name = path.stem().string()};
    for (std::size_t i = 0; i < order.file_index.size(); ++i)
        model.nodes.push_back(convert_node(document, order.file_index[i], order.parent[i]));
    // The others only for what is wrong with them.
    for (std::uint32_t i = 0; i < order.new_index.size(); ++i)
        if (order.new_index[i] == no_index) static_cast<void>(convert_node(document, i, no_index));
    DARKROOM_TRY(convert_drawn(document, order, model));
    DARKROOM_TRY(check_nodes(document, order, model));
    DARKROOM_TRY(convert_rest(document, order, model));
    read_variant_names(document.model(), model.variants);
    DARKROOM_TRY(gltf::add_instances(document, order, model));
    DARKROOM_TRY(document.budget().check());
    model.file_bytes = document.budget().file_bytes();
    for (std::string& warning : document.faults().take_warnings())
        model.warnings.push_back(one_printable_line(warning));
    return model;
}

}  // namespace

Result<Model> read_model(const std::filesystem::path& path, Budget budget, NamedFiles named_files) {
    try {
        auto model = read(path, std::move(budget), named_files);
        if (model) return model;
        Error error = model.error();
        error.text = fmt::format("{}: {}", path.string(), one_printable_line(error.text));
        return failure(std::move(error));
    } catch (const std::exception& exception) {
        return user_error(fmt::format("{}: cannot be read: {}", path.string(), one_printable_line(exception.what())));
    }
}

}  // namespace darkroom::scene
