// SPDX-License-Identifier: MIT
// Makes what the shipped scenes are built of and nobody would want to read in a repository: models/*.glb, sky.hdr and
// flames.png, in the folder that is its argument.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>

#include "image/picture/write.hpp"
#include "shapes.hpp"

namespace {

using namespace darkroom::scenes;
using darkroom::Picture;

constexpr float stride_seconds = 1.1F;

/// A model with one buffer that grows.
class Writer {
  public:
    Writer() {
        model_.asset.version = "2.0";
        model_.asset.generator = "Darkroom";
        model_.buffers.resize(1);
        model_.scenes.resize(1);
        model_.defaultScene = 0;
    }

    template <class T>
    int add(const std::vector<T>& values, int component, int type, int target = 0) {
        std::vector<unsigned char>& data = model_.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = values.size() * sizeof(T);
        view.target = target;
        data.resize(data.size() + view.byteLength);
        std::memcpy(data.data() + view.byteOffset, values.data(), view.byteLength);
        model_.bufferViews.push_back(view);
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
        accessor.componentType = component;
        accessor.count = values.size();
        accessor.type = type;
        model_.accessors.push_back(accessor);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int add_mesh(const Mesh& mesh, const tinygltf::Material& material) {
        constexpr int vertices = TINYGLTF_TARGET_ARRAY_BUFFER;
        tinygltf::Primitive primitive;
        const int positions = add(mesh.positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, vertices);
        darkroom::scene::Box box;
        for (const vec3& position : mesh.positions) box.add(position);
        model_.accessors[static_cast<std::size_t>(positions)].minValues = {box.low.x, box.low.y, box.low.z};
        model_.accessors[static_cast<std::size_t>(positions)].maxValues = {box.high.x, box.high.y, box.high.z};
        primitive.attributes["POSITION"] = positions;
        primitive.attributes["NORMAL"] = add(mesh.normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, vertices);
        primitive.attributes["TEXCOORD_0"] = add(mesh.uvs, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, vertices);
        if (!mesh.joints.empty()) {
            primitive.attributes["JOINTS_0"] =
                add(mesh.joints, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, vertices);
            primitive.attributes["WEIGHTS_0"] =
                add(mesh.weights, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, vertices);
        }
        primitive.indices = add(mesh.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        model_.materials.push_back(material);
        primitive.material = static_cast<int>(model_.materials.size()) - 1;
        tinygltf::Mesh out;
        out.primitives.push_back(primitive);
        model_.meshes.push_back(out);
        return static_cast<int>(model_.meshes.size()) - 1;
    }

    int add_node(const std::string& name, int parent) {
        model_.nodes.emplace_back();
        model_.nodes.back().name = name;
        const int node = static_cast<int>(model_.nodes.size()) - 1;
        if (parent >= 0)
            model_.nodes[static_cast<std::size_t>(parent)].children.push_back(node);
        else
            model_.scenes[0].nodes.push_back(node);
        return node;
    }
    tinygltf::Node& node(int number) { return model_.nodes[static_cast<std::size_t>(number)]; }
    tinygltf::Model& model() { return model_; }

    /// What fills the crucible: a disc that bulges a little.
    std::vector<vec2> melt_profile() { return {{0.75F, 0.85F}, {0.5F, 0.885F}, {0.2F, 0.9F}, {0, 0.9F}}; }

    bool save(const std::filesystem::path& path) {
        return tinygltf::TinyGLTF().WriteGltfSceneToFile(&model_, path.string(), true, true, false, true);
    }

  private:
    tinygltf::Model model_;
};

tinygltf::Material material(vec3 color, double metallic, double roughness) {
    tinygltf::Material out;
    out.pbrMetallicRoughness.baseColorFactor = {color.x, color.y, color.z, 1};
    out.pbrMetallicRoughness.metallicFactor = metallic;
    out.pbrMetallicRoughness.roughnessFactor = roughness;
    return out;
}

bool save_shape(const std::filesystem::path& path, const Mesh& mesh, const tinygltf::Material& surface) {
    Writer writer;
    writer.node(writer.add_node(path.stem().string(), -1)).mesh = writer.add_mesh(mesh, surface);
    return writer.save(path);
}

bool save_figure(const std::filesystem::path& path) {
    Writer writer;
    const std::vector<Bone> bones = figure_bones();
    const int body = writer.add_node("body", -1);
    tinygltf::Skin skin;
    std::vector<darkroom::scene::mat4> inverse_bind;
    const int first = body + 1;
    for (std::size_t i = 0; i < bones.size(); ++i) {
        const bool is_root = bones[i].parent == i;
        const int node = writer.add_node(bones[i].name, is_root ? -1 : first + static_cast<int>(bones[i].parent));
        const vec3 offset = is_root ? bones[i].position : bones[i].position - bones[bones[i].parent].position;
        writer.node(node).translation = {offset.x, offset.y, offset.z};
        skin.joints.push_back(node);
        inverse_bind.push_back(glm::translate(darkroom::scene::mat4(1), -bones[i].position));
    }
    skin.inverseBindMatrices = writer.add(inverse_bind, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_MAT4);
    writer.model().skins.push_back(skin);
    writer.node(body).mesh = writer.add_mesh(figure(), material({0.55F, 0.16F, 0.1F}, 0, 0.45));
    writer.node(body).skin = 0;

    constexpr std::uint32_t keys = 17;
    std::vector<float> times;
    for (std::uint32_t key = 0; key < keys; ++key)
        times.push_back(stride_seconds * static_cast<float>(key) / static_cast<float>(keys - 1));
    const int input = writer.add(times, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
    writer.model().accessors[static_cast<std::size_t>(input)].minValues = {0};
    writer.model().accessors[static_cast<std::size_t>(input)].maxValues = {stride_seconds};
    tinygltf::Animation walk;
    walk.name = "walk";
    for (std::uint32_t bone = 0; bone < bones.size(); ++bone) {
        std::vector<vec4> values;
        for (const quat& rotation : stride(bone, keys))
            values.emplace_back(rotation.x, rotation.y, rotation.z, rotation.w);
        tinygltf::AnimationSampler sampler;
        sampler.input = input;
        sampler.output = writer.add(values, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4);
        sampler.interpolation = "LINEAR";
        walk.samplers.push_back(sampler);
        tinygltf::AnimationChannel channel;
        channel.sampler = static_cast<int>(bone);
        channel.target_node = first + static_cast<int>(bone);
        channel.target_path = "rotation";
        walk.channels.push_back(channel);
    }
    writer.model().animations.push_back(walk);
    return writer.save(path);
}

/// A clear late-afternoon sky over pale ground: linear radiance, sun toward (0.6, 1, 0.4).
Picture sky() {
    constexpr float pi = std::numbers::pi_v<float>;
    Picture out(512, 256);
    const vec3 sun = glm::normalize(vec3(0.6F, 1, 0.4F));
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const float longitude = ((static_cast<float>(x) + 0.5F) / 512 - 0.5F) * 2 * pi;
            const float latitude = (0.5F - (static_cast<float>(y) + 0.5F) / 256) * pi;
            const vec3 direction(std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                                 -std::cos(longitude) * std::cos(latitude));
            const float height = std::max(direction.y, 0.0F);
            const vec3 above = glm::mix(vec3(0.85F, 0.8F, 0.72F), vec3(0.12F, 0.26F, 0.6F), std::pow(height, 0.45F));
            // The ground loses itself in the haze of the horizon.
            const vec3 haze(0.85F, 0.8F, 0.72F), ground(0.22F, 0.19F, 0.16F);
            const vec3 below = glm::mix(ground, haze, std::exp(std::min(direction.y, 0.0F) * 9));
            vec3 color = direction.y < 0 ? below : above;
            const float toward = glm::dot(direction, sun);
            color += vec3(1, 0.85F, 0.6F) * (0.5F * std::pow(std::max(toward, 0.0F), 24.0F));
            color += vec3(1, 0.9F, 0.75F) * (60 * glm::smoothstep(0.9994F, 0.9999F, toward));
            float* const pixel = out.at(x, y);
            for (int channel = 0; channel < 3; ++channel) pixel[channel] = color[channel];
            pixel[3] = 1;
        }
    }
    return out;
}

/// Four frames of a flame side by side, 128 pixels each. Alpha is one half at the outline and changes by a tenth a
/// pixel, so that what is filtered and cut off at one half has a smooth outline at any size.
Picture flames() {
    constexpr std::uint32_t side = 128, frames = 4;
    Picture out(side * frames, side);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side * frames; ++x) {
            const auto frame = static_cast<float>(x / side);
            const float u = (static_cast<float>(x % side) + 0.5F) / side * 2 - 1;
            const float v = 1 - (static_cast<float>(y) + 0.5F) / side;
            const float sway = 0.22F * std::sin(v * 5 + frame * 1.6F) * v;
            const float rise = std::max(v - 0.02F, 0.0F);
            const float width = 0.72F * std::sqrt(rise) * (1 - v) * 1.5F;
            const float away = std::abs(u - sway);
            const float heat = glm::clamp((1 - away / std::max(width, 1e-3F)) * 1.4F, 0.0F, 1.0F);
            const float inside = (width - away) * 0.5F * side;  // pixels from the outline
            float* const pixel = out.at(x, y);
            pixel[0] = 1;
            pixel[1] = 0.35F + 0.6F * heat;
            pixel[2] = 0.08F + 0.7F * heat * heat * (1 - v);
            pixel[3] = glm::clamp(0.5F + 0.1F * inside, 0.0F, 1.0F);
        }
    }
    return out;
}

std::vector<vec2> column_profile() {
    std::vector<vec2> profile{{0, 0},         {0.55F, 0},     {0.55F, 0},    {0.55F, 0.25F}, {0.55F, 0.25F},
                              {0.42F, 0.32F}, {0.42F, 0.32F}, {0.38F, 0.4F}, {0.36F, 1.5F},  {0.34F, 3},
                              {0.31F, 5.2F},  {0.31F, 5.2F},  {0.4F, 5.35F}, {0.52F, 5.5F},  {0.52F, 5.5F},
                              {0.52F, 6},     {0.52F, 6},     {0, 6}};
    return profile;
}

/// A wall of its own thickness, so that it may be glass.
std::vector<vec2> vase_profile() {
    return {{0, 0},          {0.09F, 0},     {0.09F, 0},      {0.13F, 0.08F},  {0.14F, 0.16F},  {0.09F, 0.27F},
            {0.075F, 0.32F}, {0.1F, 0.38F},  {0.1F, 0.38F},   {0.092F, 0.38F}, {0.067F, 0.32F}, {0.08F, 0.27F},
            {0.13F, 0.16F},  {0.12F, 0.08F}, {0.08F, 0.015F}, {0, 0.015F}};
}

std::vector<vec2> pot_profile() {
    return {{0, 0},        {0.16F, 0},    {0.16F, 0},   {0.22F, 0.34F}, {0.22F, 0.34F}, {0.24F, 0.34F}, {0.24F, 0.34F},
            {0.24F, 0.4F}, {0.24F, 0.4F}, {0.2F, 0.4F}, {0.2F, 0.4F},   {0.19F, 0.33F}, {0.19F, 0.33F}, {0, 0.33F}};
}

tinygltf::Material thin(tinygltf::Material surface) {
    surface.doubleSided = true;
    return surface;
}

std::vector<vec2> crucible_profile() {
    return {{0, 0},     {0.5F, 0.02F}, {0.72F, 0.2F}, {0.85F, 0.55F}, {0.88F, 1}, {0.88F, 1},
            {0.76F, 1}, {0.76F, 1},    {0.73F, 0.6F}, {0.6F, 0.3F},   {0, 0.25F}};
}

/// What fills the crucible: a disc that bulges a little.
std::vector<vec2> melt_profile() { return {{0.75F, 0.85F}, {0.5F, 0.885F}, {0.2F, 0.9F}, {0, 0.9F}}; }

bool save(const std::filesystem::path& path, const Picture& picture, bool has_alpha) {
    const darkroom::Result<> done = darkroom::write_picture(path, picture, {.alpha = has_alpha});
    if (!done) fmt::print(stderr, "{}\n", done.error().text);
    return done.has_value();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "make_scene_assets: expected a folder\n");
        return 1;
    }
    const std::filesystem::path folder = argv[1], models = folder / "models";
    std::error_code error;
    std::filesystem::create_directories(models, error);
    const bool is_done =
        save_shape(models / "sphere.glb", sphere(1, 64, 32), material(vec3(0.8F), 0, 0.5)) &&
        save_shape(models / "column.glb", lathe(column_profile(), 32), material({0.72F, 0.66F, 0.55F}, 0, 0.8)) &&
        save_shape(models / "crucible.glb", lathe(crucible_profile(), 48),
                   material({0.09F, 0.08F, 0.075F}, 0.6, 0.6)) &&
        save_shape(models / "melt.glb", lathe(melt_profile(), 48), material({0.3F, 0.1F, 0.02F}, 0, 0.4)) &&
        save_shape(models / "vase.glb", lathe(vase_profile(), 48), material({0.8F, 0.9F, 0.88F}, 0, 0.05)) &&
        save_shape(models / "pot.glb", lathe(pot_profile(), 48), material({0.5F, 0.24F, 0.15F}, 0, 0.85)) &&
        save_shape(models / "curtain.glb", curtain(1, 2.4F, 7), thin(material({0.75F, 0.68F, 0.56F}, 0, 0.95))) &&
        save_shape(models / "plant.glb", plant(26, 1.1F), thin(material({0.13F, 0.3F, 0.1F}, 0, 0.5))) &&
        save_figure(models / "figure.glb") && save(folder / "sky.hdr", sky(), false) &&
        save(folder / "flames.png", flames(), true);
    if (is_done) return 0;
    fmt::print(stderr, "make_scene_assets: could not write into {}\n", folder.string());
    return 1;
}
