// SPDX-License-Identifier: MIT
#pragma once
// The conversions from a checked document to the parts of a Model. An error is for the caller to judge: what the scene
// of the file needs is an error of the file, everything else a warning.

#include <darkroom/result.hpp>
#include <string>
#include <vector>

#include "scene/gltf/document.hpp"
#include "scene/model.hpp"

namespace darkroom::scene::gltf {

[[nodiscard]] Result<Mesh> convert_mesh(Document& document, std::size_t index);

/// `is_broken[i]`: image i could not be decoded; textures of it are left out, which draws white (flat, for normals).
[[nodiscard]] Result<ModelMaterial> convert_material(Document& document, std::size_t index,
                                                     const std::vector<bool>& is_broken);

/// Decodes on several threads; broken ones are warnings and stay empty.
/// What cannot be decoded is white, with a warning; an error is the machine's.
[[nodiscard]] Result<std::vector<Image>> convert_images(Document& document);

/// The nodes of the default scene, parents first, and where each node of the file went (no_index: not in the scene).
struct NodeOrder {
    std::vector<std::uint32_t> file_index;  ///< of each node of the model
    std::vector<std::uint32_t> parent;      ///< in the new order
    std::vector<std::uint32_t> new_index;   ///< of each node of the file
    std::vector<std::uint32_t> root;        ///< the topmost node above each node of the file
};
[[nodiscard]] Result<NodeOrder> order_nodes(Document& document);

/// Transform, names and weights; indices as they are in the file, except the parent.
[[nodiscard]] Node convert_node(Document& document, std::uint32_t file_index, std::uint32_t parent);

/// EXT_mesh_gpu_instancing: behind the nodes of the model a node for each instance, below the one that had the mesh.
/// To be called last, since nothing else knows of these nodes.
[[nodiscard]] Result<> add_instances(Document& document, const NodeOrder& order, Model& model);

/// Joints as nodes of the model.
[[nodiscard]] Result<Skin> convert_skin(Document& document, std::size_t index, const NodeOrder& order);
[[nodiscard]] ModelCamera convert_camera(Document& document, std::size_t index);
[[nodiscard]] Light convert_light(Document& document, std::size_t index);

/// The nodes and meshes of the model must be in place. An animation that is faulty anywhere is an error.
[[nodiscard]] Result<Animation> convert_animation(Document& document, std::size_t index, const NodeOrder& order,
                                                  const Model& model);

[[nodiscard]] inline float as_float(double value) { return static_cast<float>(value); }

/// A number of an extension, as the library keeps it.
[[nodiscard]] double number_of(const tinygltf::Value& object, const std::string& name, double otherwise);

}  // namespace darkroom::scene::gltf
