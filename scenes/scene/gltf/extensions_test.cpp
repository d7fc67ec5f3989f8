// SPDX-License-Identifier: MIT
// Extensions that say where a mesh is drawn, and of what.
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <array>
#include <functional>

#include "image/test_files.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {
namespace {

class SceneGltfExtensions : public WithFolder {
  protected:
    Result<Model> read(TestModel& test) {
        put(file("model.gltf"), test.text());
        return read_model(file("model.gltf"));
    }
    static nlohmann::json& attributes(TestModel& test) {
        return test.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    }
    /// A triangle under a moved node, three times.
    static TestModel with_instances() {
        TestModel test;
        test.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
        test.add_triangle();
        test.json["nodes"][0]["translation"] = {10, 0, 0};
        attributes(test)["TRANSLATION"] = test.accessor<float>({0, 0, 0, 1, 2, 3, -1, 0, 0}, "VEC3");
        // The second is turned about y by a right angle, in normalized bytes.
        attributes(test)["ROTATION"] =
            test.accessor<std::int8_t>({0, 0, 0, 127, 0, 90, 0, 90, 0, 0, 0, 127}, "VEC4", true);
        attributes(test)["SCALE"] = test.accessor<float>({1, 1, 1, 2, 2, 2, 1, 1, 1}, "VEC3");
        return test;
    }
    void expect_refused(const char* part, const std::function<void(TestModel&)>& damage) {
        TestModel test = with_instances();
        damage(test);
        const auto model = read(test);
        ASSERT_FALSE(model) << part;
        EXPECT_NE(model.error().text.find(part), std::string::npos) << model.error().text;
    }
    /// A red triangle that is green as "grass" and blue as "sea".
    static TestModel with_variants() {
        TestModel test;
        auto& primitive = test.add_triangle();
        test.json["extensionsUsed"] = {"KHR_materials_variants"};
        for (const char* name : {"red", "green", "blue"}) test.json["materials"].push_back({{"name", name}});
        test.json["extensions"]["KHR_materials_variants"]["variants"] = {
            {{"name", "grass"}}, {{"name", "sea"}}, {{"name", "rust"}}};
        primitive["material"] = 0;
        primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 2}, {"variants", {1}}},
                                                                         {{"material", 1}, {"variants", {0}}}};
        return test;
    }
    /// A triangle of two colours side by side, as WebP; those who cannot read it have an image that is missing.
    static TestModel with_webp() {
        TestModel test;
        test.add_triangle()["material"] = 0;
        test.json["extensionsUsed"] = {"EXT_texture_webp"};
        const std::vector<std::uint8_t> pixels{250, 100, 50, 255, 20, 40, 60, 128};
        std::uint8_t* bytes = nullptr;
        const std::size_t size = WebPEncodeLosslessRGBA(pixels.data(), 2, 1, 8, &bytes);
        const std::size_t view = test.view(std::vector<std::uint8_t>(bytes, bytes + size));
        WebPFree(bytes);
        test.json["images"] = {{{"uri", "missing.png"}}, {{"bufferView", view}, {"mimeType", "image/webp"}}};
        test.json["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
        test.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        return test;
    }
    Result<Scene> with_variant(const char* name) {
        return parse_scene(std::string("[entities.a.model]\nasset = \"model.gltf\"\nvariant = \"") + name + "\"\n",
                           file("a.toml"));
    }
};

TEST_F(SceneGltfExtensions, InstancesAreNodesBelowTheirs) {
    TestModel test = with_instances();
    const auto model = read(test);
    ASSERT_TRUE(model) << model.error().text;
    ASSERT_EQ(model->nodes.size(), 4U);
    EXPECT_EQ(model->nodes[0].mesh, no_index);
    const Pose at_rest = pose(*model, no_index, 0);
    const std::array<vec3, 3> corners{vec3(11, 0, 0), vec3(11, 2, 1), vec3(10, 0, 0)};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(model->nodes[i + 1].mesh, 0U);
        EXPECT_EQ(model->nodes[i + 1].parent, 0U);
        const vec3 corner(at_rest.nodes[i + 1] * vec4(1, 0, 0, 1));
        EXPECT_LT(glm::length(corner - corners[i]), 1e-5F) << i;
    }
}

TEST_F(SceneGltfExtensions, InstancesThatAreNoneAreRefused) {
    expect_refused(
        "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE: accessor 4 has 2 elements, the others",
        [](TestModel& test) {
            attributes(test)["SCALE"] = test.accessor<float>({1, 1, 1, 1, 1, 1}, "VEC3");
        });
    expect_refused("has 4 components, 3 are needed", [](TestModel& test) { attributes(test)["TRANSLATION"] = 2; });
    expect_refused("integers that are not normalized", [](TestModel& test) {
        attributes(test)["TRANSLATION"] = test.accessor<std::uint8_t>(std::vector<std::uint8_t>(9), "VEC3");
    });
    expect_refused("not finite", [](TestModel& test) {
        attributes(test)["SCALE"] = test.accessor<float>({1, 1, 1, 1, 1e30F * 1e30F, 1, 1, 1, 1}, "VEC3");
    });
    expect_refused("attributes/SCALE: 99, there are 4 accessors",
                   [](TestModel& test) { attributes(test)["SCALE"] = 99; });
    expect_refused("EXT_mesh_gpu_instancing: 7, an object is needed",
                   [](TestModel& test) { test.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = 7; });
}

// Without data, elements are zeros, however many there are.
TEST_F(SceneGltfExtensions, InstancesOutOfProportionAreToldBeforeTheyAreMade) {
    expect_refused("instances of 1024 bytes", [](TestModel& test) {
        attributes(test).clear();
        test.json["accessors"].push_back({{"componentType", 5126}, {"count", 200000}, {"type", "VEC3"}});
        attributes(test)["TRANSLATION"] = 4;
    });
    expect_refused("numbers of 4 bytes", [](TestModel& test) {
        test.json["accessors"].push_back({{"componentType", 5126}, {"count", 1ULL << 40U}, {"type", "VEC3"}});
        attributes(test)["TRANSLATION"] = 4;
    });
}

TEST_F(SceneGltfExtensions, AVariantIsChosenByItsName) {
    TestModel test = with_variants();
    const auto model = read(test);
    ASSERT_TRUE(model) << model.error().text;
    EXPECT_EQ(model->variants, (std::vector<std::string>{"grass", "sea", "rust"}));
    for (const auto& [variant, material] :
         {std::pair{"", "red"}, std::pair{"grass", "green"}, std::pair{"sea", "blue"}, std::pair{"rust", "red"}}) {
        const auto scene = with_variant(variant);
        ASSERT_TRUE(scene) << scene.error().text;
        const Assets assets = load_assets(*scene);
        ASSERT_TRUE(check_snapshot(*scene, assets)) << variant;
        const Snapshot drawn = snapshot(*scene, assets, {});
        ASSERT_EQ(drawn.instances.size(), 1U);
        EXPECT_EQ(drawn.materials[drawn.instances[0].material].surface.name, material) << variant;
    }
}

TEST_F(SceneGltfExtensions, AVariantThatIsNoneIsRefusedWithThoseThatAre) {
    TestModel test = with_variants();
    put(file("model.gltf"), test.text());
    const auto error_of = [&] {
        const auto scene = with_variant("snow");
        const auto checked = check_snapshot(*scene, load_assets(*scene));
        return checked ? "is drawn" : checked.error().text;
    };
    EXPECT_TRUE(error_of().ends_with(R"(entities.a.model.variant = "snow": allowed is "grass", "sea", "rust")"))
        << error_of();
    TestModel plain;
    plain.add_triangle();
    put(file("model.gltf"), plain.text());
    EXPECT_TRUE(error_of().ends_with("the model has no variants")) << error_of();
    test.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"] = {3};
    const auto model = read(test);
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().text.find("mappings/0/variants/0: 3, there are 3 variants"), std::string::npos)
        << model.error().text;
}

TEST_F(SceneGltfExtensions, ATextureOfWebpComesBeforeItsOtherImage) {
    TestModel test = with_webp();
    const auto model = read(test);
    ASSERT_TRUE(model) << model.error().text;
    const Texture& texture = model->materials[0].base_color_texture;
    ASSERT_EQ(texture.image, 1U);
    EXPECT_EQ(model->images[1].rgba, (std::vector<std::uint8_t>{250, 100, 50, 255, 20, 40, 60, 128}));
}

TEST_F(SceneGltfExtensions, AWebpThatIsNoneIsToldAndDrawnWhite) {
    const auto warnings_of = [&](TestModel test) {
        const auto model = read(test);
        std::string out;
        if (model)
            for (const std::string& warning : model->warnings) out += warning + "\n";
        return model ? out : model.error().text;
    };
    TestModel cut = with_webp();
    cut.json["bufferViews"][1]["byteLength"] = 25;
    EXPECT_NE(warnings_of(cut).find("/images/1: truncated: 25 bytes of "), std::string::npos) << warnings_of(cut);
    // 16384x16384 pixels in 26 bytes.
    TestModel bomb = with_webp();
    const std::string head("RIFF\x12\0\0\0WEBPVP8L\x05\0\0\0\x2f\xff\xff\xff\x0f\0", 26);
    bomb.json["images"][1]["bufferView"] = bomb.view(std::vector<char>(head.begin(), head.end()));
    EXPECT_NE(warnings_of(bomb).find("/images/1: a picture of 16384x16384 cannot be in a file of 26 bytes"),
              std::string::npos)
        << warnings_of(bomb);
    TestModel none = with_webp();
    none.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 2;
    EXPECT_NE(warnings_of(none).find("source: 2, there are 2 images"), std::string::npos) << warnings_of(none);
}

}  // namespace
}  // namespace darkroom::scene
