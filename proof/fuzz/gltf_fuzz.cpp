// SPDX-License-Identifier: MIT
// glTF, as a container or as text: a model that was read keeps what its header promises (scene/model.hpp), so that
// nobody behind the reader checks an index.

#include <fmt/format.h>

#include <algorithm>

#include "fuzz/target.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/model.hpp"

namespace darkroom::fuzz::gltf_fuzz {
namespace {

using namespace scene;

bool is_index(std::uint32_t index, std::size_t count) { return index == no_index || index < count; }

std::string wrong_primitive(const Model& model, const Primitive& primitive, std::size_t weights) {
    const std::size_t count = primitive.vertices.size();
    if (!std::ranges::all_of(primitive.indices, [&](std::uint32_t i) { return i < count; }) ||
        primitive.indices.size() % 3 != 0)
        return "an index of a primitive is out of range";
    if (!primitive.skin.empty() && primitive.skin.size() != count) return "arrays of a primitive have other lengths";
    if (primitive.targets.size() != weights) return "a mesh has other weights than targets";
    for (const MorphTarget& target : primitive.targets)
        if (target.positions.size() != count || (!target.normals.empty() && target.normals.size() != count))
            return "a morph target has another length";
    if (!is_index(primitive.material, model.materials.size())) return "a material is out of range";
    for (std::size_t i = 0; i < primitive.variants.size(); ++i)
        if (primitive.variants[i].variant >= model.variants.size() ||
            !is_index(primitive.variants[i].material, model.materials.size()) ||
            (i > 0 && primitive.variants[i].variant <= primitive.variants[i - 1].variant))
            return "a variant is out of range, or of order";
    return {};
}

std::string wrong_nodes(const Model& model) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        if (node.parent != no_index && node.parent >= i) return "a node stands before its parent";
        if (!is_index(node.mesh, model.meshes.size()) || !is_index(node.skin, model.skins.size()) ||
            !is_index(node.camera, model.cameras.size()) || !is_index(node.light, model.lights.size()))
            return "what a node names is out of range";
        if (!node.weights.empty() &&
            (node.mesh == no_index || node.weights.size() != model.meshes[node.mesh].weights.size()))
            return "a node has other weights than its mesh";
        if (node.mesh == no_index || node.skin == no_index) continue;
        for (const Primitive& primitive : model.meshes[node.mesh].primitives)
            for (const VertexSkin& vertex : primitive.skin)
                for (const std::uint16_t joint : vertex.joints)
                    if (joint >= model.skins[node.skin].joints.size()) return "a joint is out of range";
    }
    return {};
}

std::string wrong_animation(const Model& model, const Animation& animation) {
    for (const AnimationChannel& channel : animation.channels) {
        const std::size_t each = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
        if (channel.node >= model.nodes.size()) return "a channel's node is out of range";
        if (channel.values.size() != each * channel.width * channel.times.size()) return "a channel has other values";
        if (!std::ranges::is_sorted(channel.times)) return "a channel's times do not increase";
    }
    return {};
}

std::string wrong_model(const Model& model) {
    for (const Image& image : model.images) {
        const std::size_t samples = std::size_t{4} * image.width * image.height;
        if (!image.is_empty() && image.rgba.size() + image.wide.size() != samples) return "an image has other samples";
    }
    for (const ModelMaterial& material : model.materials)
        for (const TextureUse& use : textures_of(material))
            if (!is_index(use.texture->image, model.images.size())) return "a texture's image is out of range";
    for (const Mesh& mesh : model.meshes)
        for (const Primitive& primitive : mesh.primitives)
            if (std::string wrong = wrong_primitive(model, primitive, mesh.weights.size()); !wrong.empty())
                return wrong;
    for (const Skin& skin : model.skins)
        if (skin.inverse_bind.size() != skin.joints.size() ||
            std::ranges::any_of(skin.joints, [&](std::uint32_t joint) { return joint >= model.nodes.size(); }))
            return "a skin's joints are out of range";
    for (const Animation& animation : model.animations)
        if (std::string wrong = wrong_animation(model, animation); !wrong.empty()) return wrong;
    return wrong_nodes(model);
}

std::string run(std::string_view input) {
    const MemoryFile file(input);
    const Result<Model> model = read_model(file.path());
    if (!model) return wrong_error(model.error());
    for (const std::string& warning : model->warnings)
        if (std::string wrong = wrong_line(warning); !wrong.empty()) return wrong;
    return wrong_model(*model);
}

std::string number(std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&word), sizeof word};
}

/// As a container, whose bytes a fuzzer reaches without base64.
std::string container(TestModel& model) {
    model.json["buffers"] = {{{"byteLength", model.bytes.size()}}};
    std::string json = model.json.dump(), binary = model.bytes;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return "glTF" + number(2) + number(28 + json.size() + binary.size()) + number(json.size()) + "JSON" + json +
           number(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::vector<std::string> made() {
    TestModel triangle, figure, moving, drawn;
    triangle.add_triangle();
    figure.add_figure();
    moving.add_triangle()["targets"] = {{{"POSITION", moving.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC3")}}};
    const std::size_t times = moving.accessor<float>({0, 1}, "SCALAR"),
                      weights = moving.accessor<float>({0, 1}, "SCALAR");
    moving.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
                                  {"samplers", {{{"input", times}, {"output", weights}}}}}};
    auto& primitive = drawn.add_triangle();
    primitive["indices"] = drawn.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
    primitive["attributes"]["TEXCOORD_0"] = drawn.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    primitive["attributes"]["COLOR_0"] = drawn.accessor<std::uint8_t>(std::vector<std::uint8_t>(12, 200), "VEC4", true);
    primitive["material"] = 0;
    drawn.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}, {"alphaMode", "MASK"}}};
    drawn.json["textures"] = {{{"source", 0}}};
    drawn.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    drawn.json["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
    drawn.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_variants"};
    drawn.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"intensity", 10}}}}}},
                                {"KHR_materials_variants", {{"variants", {{{"name", "red"}}}}}}};
    drawn.json["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    std::vector<std::string> out;
    for (TestModel* const model : {&triangle, &figure, &moving, &drawn}) {
        out.push_back(TestModel(*model).text());
        out.push_back(container(*model));
    }
    return out;
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = made();
    for (const char* const pattern : {"data/*.gltf", "data/*.glb"})
        std::ranges::move(files(pattern), std::back_inserter(out));
    return out;
}

// What is free however small a file is.
constexpr std::size_t max_mebibytes = 160;
const Registration gltf({"gltf", run, seeds, 16384, max_mebibytes});

}  // namespace
}  // namespace darkroom::fuzz::gltf_fuzz
