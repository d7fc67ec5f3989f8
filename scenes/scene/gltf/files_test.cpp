// SPDX-License-Identifier: MIT
// Files that others have made, good and bad ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "image/test_files.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

namespace fs = std::filesystem;

class SceneGltfFiles : public WithData {
  protected:
    static Result<Model> read_in_time(const fs::path& path) {
        const auto start = std::chrono::steady_clock::now();
        auto model = read_model(path);
        const auto seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_LT(seconds, 5) << path;
        if (!model) {
            EXPECT_TRUE(model.error().text.starts_with(path.string() + ": ")) << model.error().text;
        }
        return model;
    }
    static std::vector<fs::path> models_in(const fs::path& folder) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
                files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        return files;
    }
    static void expect_consistent(const Model& model, const fs::path& path) {
        for (std::size_t i = 0; i < model.nodes.size(); ++i) {
            const Node& node = model.nodes[i];
            if (node.parent != no_index) {
                ASSERT_LT(node.parent, i) << path;
            }
            if (node.mesh != no_index) {
                ASSERT_LT(node.mesh, model.meshes.size()) << path;
            }
            if (node.skin != no_index) {
                ASSERT_LT(node.skin, model.skins.size()) << path;
            }
            if (node.camera != no_index) {
                ASSERT_LT(node.camera, model.cameras.size()) << path;
            }
            if (node.light != no_index) {
                ASSERT_LT(node.light, model.lights.size()) << path;
            }
        }
        for (const Mesh& mesh : model.meshes)
            for (const Primitive& primitive : mesh.primitives) {
                const std::size_t count = primitive.vertices.size();
                ASSERT_EQ(primitive.indices.size() % 3, 0u) << path;
                for (const std::uint32_t index : primitive.indices) ASSERT_LT(index, count) << path;
                if (!primitive.skin.empty()) {
                    ASSERT_EQ(primitive.skin.size(), count) << path;
                }
                ASSERT_EQ(primitive.targets.size(), mesh.weights.size()) << path;
                for (const MorphTarget& target : primitive.targets) ASSERT_EQ(target.positions.size(), count) << path;
                if (primitive.material != no_index) {
                    ASSERT_LT(primitive.material, model.materials.size()) << path;
                }
            }
        for (const Animation& animation : model.animations)
            for (const AnimationChannel& channel : animation.channels) {
                ASSERT_LT(channel.node, model.nodes.size()) << path;
                const std::size_t per_key = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
                ASSERT_EQ(channel.values.size(), channel.times.size() * channel.width * per_key) << path;
            }
        for (const Skin& skin : model.skins) ASSERT_EQ(skin.joints.size(), skin.inverse_bind.size()) << path;
    }
    void read_real_models(std::size_t quarter) const {
        const std::vector<fs::path> files = models_in(data_ / "models");
        ASSERT_GT(files.size(), 10u);
        for (std::size_t i = quarter; i < files.size(); i += 4) {
            const fs::path& path = files[i];
            const auto model = read_in_time(path);
            ASSERT_TRUE(model) << model.error().text;
            expect_consistent(*model, path);
            for (const std::string& warning : model->warnings)
                EXPECT_TRUE(warning.starts_with("/extensionsUsed/")) << path << ": " << warning;
            const bool has_triangles = std::any_of(model->meshes.begin(), model->meshes.end(),
                                                   [](const Mesh& mesh) { return !mesh.primitives.empty(); });
            EXPECT_TRUE(has_triangles) << path;
            for (const Image& image : model->images) EXPECT_FALSE(image.is_empty()) << path;
        }
    }
};

// In quarters, so that none takes long.
TEST_F(SceneGltfFiles, RealModelsFirstQuarter) { read_real_models(0); }
TEST_F(SceneGltfFiles, RealModelsSecondQuarter) { read_real_models(1); }
TEST_F(SceneGltfFiles, RealModelsThirdQuarter) { read_real_models(2); }
TEST_F(SceneGltfFiles, RealModelsLastQuarter) { read_real_models(3); }

TEST_F(SceneGltfFiles, ValidatorSet) {
    const fs::path folder = data_ / "malformed";
    std::ifstream table(folder / "EXPECT_gltf_validator.csv");
    std::string line;
    std::getline(table, line);
    std::size_t count = 0;
    while (std::getline(table, line)) {
        const std::size_t comma = line.find(',');
        const fs::path path = folder / line.substr(0, comma);
        const bool is_valid = line.substr(comma + 1).starts_with("0,");
        const auto model = read_in_time(path);
        if (model) expect_consistent(*model, path);
        if (is_valid)
            EXPECT_TRUE(model) << model.error().text;
        else
            EXPECT_TRUE(!model || !model->warnings.empty()) << path << ": its faults are passed over in silence";
        ++count;
    }
    EXPECT_GT(count, 150u);
}

TEST_F(SceneGltfFiles, InvalidFilesAreRefusedOrReported) {
    for (const fs::path& path : models_in(data_ / "malformed/gltf_magnum")) {
        const auto model = read_in_time(path);
        EXPECT_TRUE(!model || !model->warnings.empty()) << path << ": its faults are passed over in silence";
        if (model) expect_consistent(*model, path);
    }
    for (const fs::path& path : models_in(data_ / "malformed/gltf_tinygltf"))
        if (const auto model = read_in_time(path)) expect_consistent(*model, path);
}

TEST_F(SceneGltfFiles, HostileFiles) {
    const auto error_of = [&](const char* name) {
        const auto model = read_in_time(data_ / "hostile" / name);
        return model ? std::string("is read") : model.error().text;
    };
    EXPECT_NE(error_of("13_gltf_accessor_out_of_range.gltf").find("beyond bufferView 0"), std::string::npos);
    EXPECT_NE(error_of("14_gltf_cyclic_node_graph.gltf").find("node cycle 0 -> 1 -> 2 -> 0"), std::string::npos);
    EXPECT_NE(error_of("15_gltf_missing_buffer.gltf").find("no_such_file.bin"), std::string::npos);
    const auto model = read_model(data_ / "hostile/16_gltf_negative_scale_ok.gltf");
    ASSERT_TRUE(model) << model.error().text;
    EXPECT_EQ(model->nodes.at(0).transform.scale, vec3(-1, 1, 1));
}

// Damage anywhere in a real file: every answer is allowed, a crash is not.
TEST_F(SceneGltfFiles, DamagedBytes) {
    const std::string original = content(data_ / "models/RiggedSimple/RiggedSimple.gltf");
    fs::copy_file(data_ / "models/RiggedSimple/RiggedSimple0.bin", file("RiggedSimple0.bin"));
    std::uint32_t state = 12345;
    const auto next = [&] { return state = state * 1664525 + 1013904223; };
    for (int round = 0; round < 300; ++round) {
        std::string damaged = original;
        for (int i = 0; i < 3; ++i) {
            constexpr std::string_view bytes = "0123456789-.eE[]{}\",:x";
            damaged[(next() >> 8) % damaged.size()] = bytes[(next() >> 8) % bytes.size()];
        }
        put(file("damaged.gltf"), damaged);
        if (const auto model = read_model(file("damaged.gltf"))) expect_consistent(*model, "damaged.gltf");
    }
}

}  // namespace
}  // namespace darkroom::scene
