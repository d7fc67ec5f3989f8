// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "image/test_files.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

// A PNG.
constexpr const char* red_pixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAA"
    "MBAQDJ/pLvAAAAAElFTkSuQmCC";

class SceneGltfRead : public WithFolder {
  protected:
    Result<Model> read(TestModel& model) {
        put(file("model.gltf"), model.text());
        return read_model(file("model.gltf"));
    }
    Model read_good(TestModel& model) {
        auto result = read(model);
        EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().text);
        return result ? std::move(*result) : Model{};
    }
    /// A triangle whose material has these extensions, with one texture to refer to.
    Model read_layers(const nlohmann::json& extensions) {
        TestModel test;
        test.add_triangle()["material"] = 0;
        test.json["images"] = {{{"uri", red_pixel}}};
        test.json["textures"] = {{{"source", 0}}};
        test.json["materials"] = {{{"extensions", extensions}}};
        Model model = read_good(test);
        EXPECT_EQ(model.materials.size(), 1u);
        model.materials.resize(1);
        return model;
    }
    const Primitive& only_primitive(const Model& model) {
        static const Primitive none;
        EXPECT_EQ(model.meshes.size(), 1u);
        return model.meshes.empty() || model.meshes[0].primitives.empty() ? none : model.meshes[0].primitives[0];
    }
};

TEST_F(SceneGltfRead, TriangleWithoutNormalsIsFlat) {
    TestModel test;
    test.add_triangle();
    const Model model = read_good(test);
    const Primitive& primitive = only_primitive(model);
    ASSERT_EQ(primitive.vertices.size(), 3u);
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    for (const Vertex& vertex : primitive.vertices) EXPECT_EQ(vertex.normal, vec3(0, 0, 1));
    EXPECT_EQ(primitive.bounds.high, vec3(1, 1, 0));
}

TEST_F(SceneGltfRead, FlatTrianglesShareNoVertices) {
    TestModel test;
    auto& primitive = test.add_triangle({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    primitive["indices"] = test.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    const Model model = read_good(test);
    ASSERT_EQ(only_primitive(model).vertices.size(), 6u);
    EXPECT_EQ(only_primitive(model).vertices[0].normal, vec3(0, 0, 1));
    EXPECT_EQ(only_primitive(model).vertices[3].normal, vec3(1, 0, 0));
}

TEST_F(SceneGltfRead, AllIndexTypes) {
    const auto check = [&](auto values) {
        TestModel test;
        auto& primitive = test.add_triangle();
        primitive["attributes"]["NORMAL"] = test.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        primitive["indices"] = test.accessor(values, "SCALAR");
        EXPECT_EQ(only_primitive(read_good(test)).indices, (std::vector<std::uint32_t>{2, 1, 0}));
    };
    check(std::vector<std::uint8_t>{2, 1, 0});
    check(std::vector<std::uint16_t>{2, 1, 0});
    check(std::vector<std::uint32_t>{2, 1, 0});
}

TEST_F(SceneGltfRead, StripsAndFansBecomeTriangles) {
    const auto indices_of = [&](int mode) {
        TestModel test;
        auto& primitive = test.add_triangle({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
        primitive["attributes"]["NORMAL"] = test.accessor<float>(std::vector<float>(15, 1.0F), "VEC3");
        primitive["mode"] = mode;
        return only_primitive(read_good(test)).indices;
    };
    EXPECT_EQ(indices_of(5), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(indices_of(6), (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST_F(SceneGltfRead, PointsAreSkippedWithAWarning) {
    TestModel test;
    test.add_triangle()["mode"] = 0;
    const Model model = read_good(test);
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_TRUE(model.meshes[0].primitives.empty());
    EXPECT_FALSE(model.warnings.empty());
}

TEST_F(SceneGltfRead, ColoursAndCoordinatesOfAllTypes) {
    TestModel test;
    auto& attributes = test.add_triangle()["attributes"];
    attributes["COLOR_0"] = test.accessor<std::uint16_t>({65535, 0, 32768, 0, 1, 0, 0, 0, 0}, "VEC3", true);
    attributes["TEXCOORD_0"] = test.accessor<float>({0.25F, 2, 0, 0, 0, 0}, "VEC2");
    attributes["TEXCOORD_1"] = test.accessor<std::uint8_t>({255, 51, 0, 0, 0, 0}, "VEC2", true);
    const Model model = read_good(test);
    const Vertex& vertex = only_primitive(model).vertices.at(0);
    EXPECT_EQ(vertex.color, vec4(1, 0, 32768 / 65535.0F, 1));
    EXPECT_EQ(only_primitive(model).vertices.at(1).color.y, 1 / 65535.0F);
    EXPECT_EQ(vertex.uv0, vec2(0.25F, 2));
    EXPECT_FLOAT_EQ(vertex.uv1.x, 1);
    EXPECT_FLOAT_EQ(vertex.uv1.y, 0.2F);
}

TEST_F(SceneGltfRead, SparseAccessorsReplaceElements) {
    TestModel test;
    auto& primitive = test.add_triangle();
    const std::size_t sparse_indices = test.view<std::uint16_t>({1});
    const std::size_t sparse_values = test.view<float>({5, 6, 7});
    test.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", sparse_indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", sparse_values}}}};
    primitive["attributes"]["NORMAL"] = test.accessor<float>(std::vector<float>(9, 1.0F), "VEC3");
    const Model model = read_good(test);
    EXPECT_EQ(only_primitive(model).vertices.at(1).position, vec3(5, 6, 7));
    EXPECT_EQ(only_primitive(model).vertices.at(2).position, vec3(0, 1, 0));
}

// The elements of the base are 24 bytes apart, those of the replacements 12.
TEST_F(SceneGltfRead, SparseElementsLieCloseOverAnInterleavedBase) {
    TestModel test;
    auto& primitive = test.add_triangle();
    const std::size_t base = test.view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1});
    test.json["bufferViews"][base]["byteStride"] = 24;
    const std::size_t sparse_indices = test.view<std::uint16_t>({0, 2});
    const std::size_t sparse_values = test.view<float>({5, 6, 7, 8, 9, 10});
    test.json["accessors"][0]["bufferView"] = base;
    test.json["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", sparse_indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", sparse_values}}}};
    primitive["attributes"]["NORMAL"] = test.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const Model model = read_good(test);
    const auto& vertices = only_primitive(model).vertices;
    EXPECT_EQ(vertices.at(0).position, vec3(5, 6, 7));
    EXPECT_EQ(vertices.at(1).position, vec3(1, 0, 0));
    EXPECT_EQ(vertices.at(2).position, vec3(8, 9, 10));
}

TEST_F(SceneGltfRead, SparseWithoutDataIsRefusedIfEnormous) {
    TestModel test;
    test.add_triangle();
    const std::size_t sparse_indices = test.view<std::uint16_t>({1});
    const std::size_t sparse_values = test.view<float>({5, 6, 7});
    test.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", sparse_indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", sparse_values}}}};
    test.json["accessors"][0].erase("bufferView");
    test.json["accessors"][0]["count"] = 1000000000;
    const auto model = read(test);
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().text.find("/accessors/0"), std::string::npos) << model.error().text;
}

TEST_F(SceneGltfRead, KeepsTheFourLargestWeights) {
    TestModel test;
    auto& attributes = test.add_triangle()["attributes"];
    std::vector<std::uint8_t> first;
    std::vector<std::uint16_t> second;
    std::vector<float> first_weights;
    std::vector<float> second_weights;
    for (int vertex = 0; vertex < 3; ++vertex) {
        first.insert(first.end(), {0, 1, 2, 3});
        second.insert(second.end(), {4, 5, 6, 7});
        first_weights.insert(first_weights.end(), {0.05F, 0.3F, 0.05F, 0.1F});
        second_weights.insert(second_weights.end(), {0.0F, 0.2F, 0.05F, 0.25F});
    }
    attributes["JOINTS_0"] = test.accessor(first, "VEC4");
    attributes["JOINTS_1"] = test.accessor(second, "VEC4");
    attributes["WEIGHTS_0"] = test.accessor(first_weights, "VEC4");
    attributes["WEIGHTS_1"] = test.accessor(second_weights, "VEC4");
    for (int joint = 0; joint < 8; ++joint) test.json["nodes"].push_back(nlohmann::json::object());
    test.json["skins"] = {{{"joints", {8, 7, 6, 5, 4, 3, 2, 1}}}};
    test.json["nodes"][0]["skin"] = 0;
    const Model model = read_good(test);
    const VertexSkin& skin = only_primitive(model).skin.at(1);
    EXPECT_EQ(skin.joints, (std::array<std::uint16_t, 4>{1, 7, 5, 3}));
    EXPECT_NEAR(skin.weights.x + skin.weights.y + skin.weights.z + skin.weights.w, 1, 1e-6);
    EXPECT_NEAR(skin.weights.x, 0.3 / 0.85, 1e-6);
    ASSERT_EQ(model.skins.size(), 1u);
    EXPECT_EQ(model.skins[0].joints.front(), 8u);
    EXPECT_EQ(model.skins[0].inverse_bind.size(), 8u);

    // A joint that the skin does not have.
    test.json["skins"][0]["joints"] = {1, 2, 3, 4, 5, 6, 7};
    const auto refused = read(test);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("joint 7"), std::string::npos) << refused.error().text;
}

TEST_F(SceneGltfRead, MorphTargets) {
    TestModel test;
    auto& primitive = test.add_triangle();
    primitive["targets"] = {{{"POSITION", test.accessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3")}}};
    test.json["meshes"][0]["weights"] = {0.5};
    const Model model = read_good(test);
    ASSERT_EQ(only_primitive(model).targets.size(), 1u);
    EXPECT_EQ(only_primitive(model).targets[0].positions.at(2), vec3(0, 0, 3));
    EXPECT_EQ(model.meshes[0].weights, std::vector<float>{0.5F});
}

// glTF 2.0 specification, 3.7.2.2: a triangle of which a corner rises, and one that is only a line at rest.
TEST_F(SceneGltfRead, MorphTargetsOfFlatTrianglesHaveNormals) {
    TestModel test;
    auto& primitive = test.add_triangle({0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0});
    std::vector<float> moved(18);
    moved[3 * 1 + 2] = 4;
    moved[3 * 5 + 1] = 1;
    primitive["targets"] = {{{"POSITION", test.accessor<float>(moved, "VEC3")}}};
    const Model model = read_good(test);
    const std::vector<Vertex>& vertices = only_primitive(model).vertices;
    const std::vector<vec3>& changes = only_primitive(model).targets.at(0).normals;
    ASSERT_EQ(changes.size(), 6U);
    for (const float weight : {0.0F, 0.25F, 0.5F, 1.0F}) {
        const vec3 found = glm::normalize(vertices[0].normal + weight * changes[0]);
        const vec3 expected = glm::normalize(glm::cross(vec3(2, 0, 4 * weight), vec3(0, 2, 0)));
        EXPECT_LT(glm::length(found - expected), 1e-6F) << weight;
    }
    EXPECT_EQ(vertices[3].normal + changes[3], vec3(0, 0, 1));
}

TEST_F(SceneGltfRead, ParentsComeBeforeChildren) {
    TestModel test;
    test.json["nodes"] = {{{"name", "leaf"}},
                          {{"name", "root"}, {"children", {3, 2}}, {"translation", {1, 2, 3}}},
                          {{"name", "middle"}, {"children", {0}}, {"rotation", {0, 0, 2, 0}}},
                          {{"name", "matrix"}, {"matrix", {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}},
                          {{"name", "elsewhere"}}};
    test.json["scenes"] = {{{"nodes", {4}}}, {{"nodes", {1}}}};
    test.json["scene"] = 1;
    const Model model = read_good(test);
    ASSERT_EQ(model.nodes.size(), 4u);
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (model.nodes[i].parent != no_index) {
            EXPECT_LT(model.nodes[i].parent, i);
        }
    EXPECT_EQ(model.nodes[0].name, "root");
    EXPECT_EQ(model.nodes[0].transform.position, vec3(1, 2, 3));
    EXPECT_EQ(model.nodes[1].name, "matrix");
    ASSERT_TRUE(model.nodes[1].matrix);
    EXPECT_EQ((*model.nodes[1].matrix)[3], vec4(7, 8, 9, 1));
    EXPECT_EQ(model.nodes[2].transform.rotation, quat(0, 0, 0, 1));
    EXPECT_EQ(model.nodes[3].name, "leaf");
    EXPECT_EQ(model.nodes[3].parent, 2u);
}

TEST_F(SceneGltfRead, MaterialsTexturesAndTheirTransforms) {
    TestModel test;
    test.add_triangle()["material"] = 0;
    test.json["images"] = {{{"uri", red_pixel}}, {{"uri", "missing.png"}}};
    test.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    test.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    const nlohmann::json transform{
        {"KHR_texture_transform",
         {{"offset", {0.5, 0.25}}, {"rotation", 1.5707963}, {"scale", {2, 3}}, {"texCoord", 1}}}};
    test.json["materials"] = {{{"name", "paint"},
                               {"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                 {"metallicFactor", 0.5},
                                 {"roughnessFactor", 0.25},
                                 {"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
                                 {"metallicRoughnessTexture", {{"index", 1}}}}},
                               {"normalTexture", {{"index", 0}, {"scale", 0.75}}},
                               {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}},
                               {"emissiveFactor", {1, 0.5, 0}},
                               {"alphaMode", "MASK"},
                               {"alphaCutoff", 0.3},
                               {"doubleSided", true},
                               {"extensions",
                                {{"KHR_materials_unlit", nlohmann::json::object()},
                                 {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}}};
    const Model model = read_good(test);
    ASSERT_EQ(model.materials.size(), 1u);
    const ModelMaterial& material = model.materials[0];
    EXPECT_EQ(material.base_color, vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(material.emissive, vec3(4, 2, 0));
    EXPECT_FLOAT_EQ(material.metallic, 0.5F);
    EXPECT_FLOAT_EQ(material.roughness, 0.25F);
    EXPECT_FLOAT_EQ(material.normal_scale, 0.75F);
    EXPECT_FLOAT_EQ(material.occlusion_strength, 0.5F);
    EXPECT_EQ(material.blend, SurfaceBlend::Mask);
    EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.3F);
    EXPECT_TRUE(material.is_double_sided);
    EXPECT_TRUE(material.is_unlit);
    const Texture& texture = material.base_color_texture;
    EXPECT_EQ(texture.image, 0u);
    EXPECT_EQ(texture.wrap_u, Wrap::Clamp);
    EXPECT_EQ(texture.wrap_v, Wrap::Mirror);
    EXPECT_TRUE(texture.is_nearest);
    EXPECT_EQ(texture.uv_set, 1u);
    // u goes to -v: (0.1, 0) is scaled to (0.2, 0), turned to (0, -0.2) and moved.
    const vec3 moved = texture.uv_transform * vec3(0.1F, 0, 1);
    EXPECT_NEAR(moved.x, 0.5F, 1e-6);
    EXPECT_NEAR(moved.y, 0.05F, 1e-6);
    EXPECT_FALSE(material.metallic_roughness_texture.is_given());
    ASSERT_EQ(model.images.size(), 2u);
    EXPECT_EQ(model.images[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255}));
    EXPECT_TRUE(model.images[1].is_empty());
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_NE(model.warnings.back().find("missing.png"), std::string::npos) << model.warnings.back();
}

TEST_F(SceneGltfRead, IndexOfRefractionAndSpecular) {
    const nlohmann::json moved{{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"texCoord", 1}}}};
    Model model = read_layers({{"KHR_materials_ior", {{"ior", 1.8}}},
                               {"KHR_materials_specular",
                                {{"specularFactor", 0.25},
                                 {"specularTexture", {{"index", 0}, {"texCoord", 1}}},
                                 {"specularColorFactor", {0.5, 1, 2}},
                                 {"specularColorTexture", {{"index", 0}, {"extensions", moved}}}}}});
    const SpecularLayer& layer = model.materials[0].specular;
    EXPECT_TRUE(layer.is_given());
    EXPECT_FLOAT_EQ(layer.index_of_refraction, 1.8F);
    EXPECT_FLOAT_EQ(layer.weight, 0.25F);
    EXPECT_EQ(layer.color, vec3(0.5F, 1, 2));
    EXPECT_EQ(layer.texture.image, 0u);
    EXPECT_EQ(layer.texture.uv_set, 1u);
    EXPECT_EQ(layer.color_texture.image, 0u);
    EXPECT_EQ(layer.color_texture.uv_set, 1u);
    EXPECT_EQ(layer.color_texture.uv_transform[2], vec3(0.5F, 0.25F, 1));
    EXPECT_EQ(read_layers({{"KHR_materials_ior", {{"ior", 0}}}}).materials[0].specular.index_of_refraction, 0);
    // What the specification has by default is nothing to be drawn.
    model = read_layers({{"KHR_materials_ior", {{"ior", 1.5}}}, {"KHR_materials_specular", nlohmann::json::object()}});
    EXPECT_FALSE(model.materials[0].specular.is_given());
}

TEST_F(SceneGltfRead, Clearcoat) {
    Model model = read_layers({{"KHR_materials_clearcoat",
                                {{"clearcoatFactor", 0.75},
                                 {"clearcoatTexture", {{"index", 0}}},
                                 {"clearcoatRoughnessFactor", 0.25},
                                 {"clearcoatRoughnessTexture", {{"index", 0}, {"texCoord", 1}}},
                                 {"clearcoatNormalTexture", {{"index", 0}, {"scale", 0.5}}}}}});
    const ClearcoatLayer& layer = model.materials[0].clearcoat;
    EXPECT_TRUE(layer.is_given());
    EXPECT_FLOAT_EQ(layer.weight, 0.75F);
    EXPECT_FLOAT_EQ(layer.roughness, 0.25F);
    EXPECT_FLOAT_EQ(layer.normal_scale, 0.5F);
    EXPECT_TRUE(layer.texture.is_given());
    EXPECT_EQ(layer.roughness_texture.uv_set, 1u);
    EXPECT_TRUE(layer.normal_texture.is_given());
    model = read_layers({{"KHR_materials_clearcoat", nlohmann::json::object()}});
    EXPECT_FALSE(model.materials[0].clearcoat.is_given());
}

TEST_F(SceneGltfRead, Sheen) {
    Model model = read_layers({{"KHR_materials_sheen",
                                {{"sheenColorFactor", {0.25, 0.5, 1}},
                                 {"sheenColorTexture", {{"index", 0}}},
                                 {"sheenRoughnessFactor", 0.75},
                                 {"sheenRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}}}});
    const SheenLayer& layer = model.materials[0].sheen;
    EXPECT_TRUE(layer.is_given());
    EXPECT_EQ(layer.color, vec3(0.25F, 0.5F, 1));
    EXPECT_FLOAT_EQ(layer.roughness, 0.75F);
    EXPECT_TRUE(layer.color_texture.is_given());
    EXPECT_EQ(layer.roughness_texture.uv_set, 1u);
    model = read_layers({{"KHR_materials_sheen", {{"sheenRoughnessFactor", 1}}}});
    EXPECT_FALSE(model.materials[0].sheen.is_given());
}

TEST_F(SceneGltfRead, LayersOutOfRangeAreOneLineEach) {
    const auto only_warning = [](const Model& model) {
        std::string of_materials;
        for (const std::string& warning : model.warnings)
            if (warning.starts_with("/materials")) of_materials += of_materials.empty() ? warning : "; " + warning;
        return of_materials;
    };
    for (const double index : {0.5, -1.0, -1e30}) {
        const Model model = read_layers({{"KHR_materials_ior", {{"ior", index}}}});
        EXPECT_EQ(only_warning(model),
                  fmt::format("/materials/0/extensions/KHR_materials_ior/ior: {}, allowed is 0 and at least 1; 1.5 is "
                              "used",
                              index));
        EXPECT_FALSE(model.materials[0].specular.is_given());
    }
    const std::string specular = "/materials/0/extensions/KHR_materials_specular/";
    Model model = read_layers({{"KHR_materials_specular", {{"specularFactor", 3}}}});
    EXPECT_EQ(only_warning(model), specular + "specularFactor: 3, allowed is 0 to 1");
    EXPECT_EQ(model.materials[0].specular.weight, 1);
    model = read_layers({{"KHR_materials_specular", {{"specularFactor", "NaN"}}}});
    EXPECT_EQ(only_warning(model), specular + "specularFactor: \"NaN\", a number is needed; it is passed over");
    model = read_layers({{"KHR_materials_specular", {{"specularColorFactor", {1, -2, 1}}}}});
    EXPECT_EQ(only_warning(model), specular + "specularColorFactor: -2, allowed is at least 0");
    EXPECT_EQ(model.materials[0].specular.color, vec3(1, 0, 1));
    model = read_layers({{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", -1}}}});
    EXPECT_EQ(only_warning(model),
              "/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor: -1, allowed is 0 to 1");
    EXPECT_EQ(model.materials[0].clearcoat.roughness, 0);
}

TEST_F(SceneGltfRead, SixteenBitsStay) {
    TestModel test;
    test.add_triangle();
    // A PNG of two pixels.
    test.json["images"] = {
        {{"uri",
          "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR4nGNoYGhwaGhgYGRg"
          "+v8fABfVBELEPnO+AAAAAElFTkSuQmCC"}}};
    const Model model = read_good(test);
    ASSERT_EQ(model.images.size(), 1u);
    EXPECT_EQ(model.images[0].kind, ImageKind::Codes16);
    EXPECT_EQ(model.images[0].wide, (std::vector<std::uint16_t>{0x8000, 0x8040, 0x8080, 65535, 1, 2, 65535, 65535}));
}

// Tangents are made where a normal map reads them, those of the file kept.
TEST_F(SceneGltfRead, NormalMapsGetTangents) {
    const auto read_with = [&](bool has_map, bool has_tangents) {
        TestModel test;
        nlohmann::json& primitive = test.add_triangle();
        primitive["attributes"]["NORMAL"] = test.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        primitive["attributes"]["TEXCOORD_0"] = test.accessor<float>({0, 0, 0, 1, 1, 0}, "VEC2");
        if (has_tangents)
            primitive["attributes"]["TANGENT"] = test.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
        primitive["material"] = 0;
        test.json["images"] = {{{"uri", red_pixel}}};
        test.json["textures"] = {{{"source", 0}}};
        test.json["materials"] = {{{has_map ? "normalTexture" : "emissiveTexture", {{"index", 0}}}}};
        const Model model = read_good(test);
        return only_primitive(model).vertices.at(0).tangent;
    };
    EXPECT_EQ(read_with(true, false), vec4(0, 1, 0, 1));
    EXPECT_EQ(read_with(true, true), vec4(1, 0, 0, 1));
    EXPECT_EQ(read_with(false, false), vec4(0));
}

TEST_F(SceneGltfRead, LightsAndCameras) {
    TestModel test;
    test.json["extensionsUsed"] = {"KHR_lights_punctual"};
    test.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
        {{"type", "point"}},
        {{"type", "spot"}, {"range", 5}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}}};
    test.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.5707963}, {"znear", 0.5}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 1}, {"zfar", 50}}}}};
    for (int i = 0; i < 3; ++i)
        test.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    test.json["nodes"][0]["camera"] = 1;
    const Model model = read_good(test);
    ASSERT_EQ(model.lights.size(), 3u);
    EXPECT_EQ(model.lights[0].type, LightType::Directional);
    EXPECT_EQ(model.lights[0].direction, vec3(0, 0, 1));
    EXPECT_EQ(model.lights[0].color, vec3(1, 0.5F, 0));
    EXPECT_FLOAT_EQ(model.lights[0].intensity, 3);
    EXPECT_FLOAT_EQ(model.lights[1].range, 1e4F);
    EXPECT_EQ(model.lights[2].direction, vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(model.lights[2].range, 5);
    EXPECT_FLOAT_EQ(model.lights[2].inner_angle, 0.1F);
    EXPECT_FLOAT_EQ(model.lights[2].outer_angle, 0.4F);
    EXPECT_EQ(model.nodes.at(2).light, 2u);
    EXPECT_EQ(model.nodes.at(0).camera, 1u);
    ASSERT_EQ(model.cameras.size(), 2u);
    EXPECT_NEAR(model.cameras[0].field_of_view, 90, 1e-4);
    EXPECT_FLOAT_EQ(model.cameras[0].near_distance, 0.5F);
    EXPECT_TRUE(std::isinf(model.cameras[0].far_distance)) << "without zfar";
    EXPECT_EQ(model.cameras[1].projection, Projection::Orthographic);
    EXPECT_FLOAT_EQ(model.cameras[1].ortho_height, 6);
}

TEST_F(SceneGltfRead, Animations) {
    TestModel test;
    test.add_triangle();
    const std::size_t times = test.accessor<float>({0, 2}, "SCALAR");
    const std::size_t moves = test.accessor<float>({0, 0, 0, 1, 2, 3}, "VEC3");
    const std::size_t turns = test.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, "VEC4", true);
    const std::size_t spline = test.accessor<float>(std::vector<float>(18, 2.0F), "VEC3");
    const auto channel = [](std::size_t sampler, const char* path) {
        return nlohmann::json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
    };
    test.json["animations"] = {{{"name", "walk"},
                                {"channels", {channel(0, "translation"), channel(1, "rotation"), channel(2, "scale")}},
                                {"samplers",
                                 {{{"input", times}, {"output", moves}, {"interpolation", "STEP"}},
                                  {{"input", times}, {"output", turns}},
                                  {{"input", times}, {"output", spline}, {"interpolation", "CUBICSPLINE"}}}}},
                               {{"name", "broken"},
                                {"channels", {channel(0, "translation")}},
                                {"samplers", {{{"input", times}, {"output", spline}}}}}};
    const Model model = read_good(test);
    ASSERT_EQ(model.animations.size(), 1u);
    EXPECT_EQ(model.animations[0].name, "walk");
    EXPECT_FLOAT_EQ(model.animations[0].duration, 2);
    const auto& channels = model.animations[0].channels;
    ASSERT_EQ(channels.size(), 3u);
    EXPECT_EQ(channels[0].interpolation, Interpolation::Step);
    EXPECT_EQ(channels[0].values, (std::vector<float>{0, 0, 0, 1, 2, 3}));
    EXPECT_EQ(channels[1].property, AnimatedProperty::Rotation);
    EXPECT_EQ(channels[1].interpolation, Interpolation::Linear);
    EXPECT_EQ(channels[1].width, 4u);
    EXPECT_EQ(channels[1].values, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0}));
    EXPECT_EQ(channels[2].interpolation, Interpolation::CubicSpline);
    EXPECT_EQ(channels[2].values.size(), 18u);
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_NE(model.warnings.back().find("/animations/1/samplers/0/output"), std::string::npos);
}

}  // namespace
}  // namespace darkroom::scene
