// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "image/test_files.hpp"
#include "scene/gltf/container.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

namespace fs = std::filesystem;

class SceneGltfRefuse : public WithFolder {
  protected:
    // The error of a good model that `damage` has made a bad one.
    std::string error_of(const std::function<void(TestModel&)>& damage) {
        TestModel test;
        auto& primitive = test.add_triangle();
        primitive["indices"] = test.accessor<std::uint8_t>({0, 1, 2}, "SCALAR");
        damage(test);
        put(file("model.gltf"), test.text());
        const auto model = read_model(file("model.gltf"));
        if (model) return "is read";
        EXPECT_TRUE(model.error().text.starts_with(file("model.gltf").string() + ": ")) << model.error().text;
        return model.error().text;
    }
    void expect(const char* part, const std::function<void(TestModel&)>& damage) {
        const std::string error = error_of(damage);
        EXPECT_NE(error.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << error;
    }
};

TEST_F(SceneGltfRefuse, TheUndamagedModelIsRead) {
    EXPECT_EQ(error_of([](TestModel&) {}), "is read");
}

TEST_F(SceneGltfRefuse, NothingAtAll) {
    EXPECT_FALSE(read_model(file("none.gltf")));
    put(file("empty.glb"), "");
    EXPECT_FALSE(read_model(file("empty.glb")));
    put(file("text.gltf"), "hello");
    EXPECT_FALSE(read_model(file("text.gltf")));
    EXPECT_FALSE(read_model(folder_));
}

TEST_F(SceneGltfRefuse, Accessors) {
    expect("/accessors/0: ends 24 bytes beyond bufferView 0",
           [](TestModel& test) { test.json["accessors"][0]["count"] = 5; });
    expect("/accessors/0: ends", [](TestModel& test) { test.json["accessors"][0]["count"] = 1099511627775; });
    expect("/accessors/0: ends 4 bytes", [](TestModel& test) { test.json["accessors"][0]["byteOffset"] = 4; });
    expect("/accessors/0/count", [](TestModel& test) { test.json["accessors"][0]["count"] = -1; });
    expect("/accessors/0/count", [](TestModel& test) { test.json["accessors"][0]["count"] = 1e300; });
    expect("/accessors/0/componentType", [](TestModel& test) { test.json["accessors"][0]["componentType"] = 5124; });
    expect("/accessors/0/type", [](TestModel& test) { test.json["accessors"][0]["type"] = "VEC5"; });
    expect("has 2 components", [](TestModel& test) { test.json["accessors"][0]["type"] = "VEC2"; });
    expect("stride of 8", [](TestModel& test) { test.json["bufferViews"][0]["byteStride"] = 8; });
    expect("/accessors/0/bufferView: 9", [](TestModel& test) { test.json["accessors"][0]["bufferView"] = 9; });
    expect("/bufferViews/0: bytes 0 to 4294967295",
           [](TestModel& test) { test.json["bufferViews"][0]["byteLength"] = 4294967295; });
    expect("/bufferViews/0/buffer: 3", [](TestModel& test) { test.json["bufferViews"][0]["buffer"] = 3; });
    expect("/buffers/0: has", [](TestModel& test) {
        static_cast<void>(test.text());
        test.json["buffers"][0]["byteLength"] = 4096;
    });
    expect("/accessors/0: 3000000000 numbers of 4 bytes, ", [](TestModel& test) {
        test.json["accessors"][0].erase("bufferView");
        test.json["accessors"][0]["count"] = 1000000000;
    });
}

// 2^32 is no offset of 0, whether the reader keeps 32 bits of it or 64.
TEST_F(SceneGltfRefuse, OffsetsOfSparseElements) {
    for (const char* part : {"indices", "values"})
        for (const std::uint64_t offset : {64ULL, (1ULL << 31U) - 2, 1ULL << 32U, ~1ULL})
            expect(fmt::format("/accessors/0/sparse/{}", part).c_str(), [&](TestModel& test) {
                const std::size_t indices = test.view<std::uint16_t>({1}), values = test.view<float>({5, 6, 7});
                auto& sparse = test.json["accessors"][0]["sparse"];
                sparse = {{"count", 1},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
                sparse[part]["byteOffset"] = offset;
            });
}

TEST_F(SceneGltfRefuse, WhatIsNamedManyTimesIsHeldOnce) {
    TestModel test;
    test.add_triangle();
    test.json["buffers"] = {{{"byteLength", test.bytes.size()}, {"uri", "data.bin"}}};
    for (int i = 0; i < 1000; ++i) test.json["buffers"].push_back({{"byteLength", 1 << 20}, {"uri", "./data.bin"}});
    for (int i = 0; i < 2; ++i) test.json["images"].push_back({{"bufferView", 0}, {"mimeType", "image/png"}});
    test.json["images"].push_back({{"uri", "picture.png"}});
    test.json["images"].push_back({{"uri", "./picture.png"}});
    test.bytes.resize(1 << 20);
    put(file("data.bin"), test.bytes);
    put(file("picture.png"), "no picture");
    put(file("model.gltf"), test.text());
    const auto model = read_model(file("model.gltf"));
    ASSERT_TRUE(model) << model.error().text;
    EXPECT_EQ(model->file_bytes, test.text().size() + (1 << 20));
    EXPECT_EQ(model->images.size(), 2U);
}

TEST_F(SceneGltfRefuse, CountsOutOfProportionAreToldBeforeTheyAreMade) {
    const auto repeat = [](const nlohmann::json& element, std::size_t count) {
        return nlohmann::json(std::vector<nlohmann::json>(count, element));
    };
    const nlohmann::json empty = nlohmann::json::object();
    expect("/materials: 60000 elements of 3072 bytes",
           [&](TestModel& test) { test.json["materials"] = repeat(empty, 60000); });
    expect("/nodes: 160000 elements of 1024", [&](TestModel& test) { test.json["nodes"] = repeat(empty, 160000); });
    expect("the JSON: 1000", [&](TestModel& test) { test.json["extras"] = repeat(0, 1000000); });
    // An animation that cannot be had is left out, but not one that is too large.
    expect("numbers of 4 bytes", [&](TestModel& test) {
        std::vector<float> times(1000);
        for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
        const std::size_t input = test.accessor(times, "SCALAR");
        test.json["accessors"].push_back({{"componentType", 5126}, {"count", 1000}, {"type", "VEC3"}});
        const nlohmann::json animation{
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
            {"samplers", {{{"input", input}, {"output", input + 1}}}}};
        test.json["animations"] = repeat(animation, 20000);
    });
}

// The table of docs/limits.md, by counts that the budget has no room for.
TEST_F(SceneGltfRefuse, WhatIsMadeOfAPrimitiveIsToldWithItsBytes) {
    const auto zeros = [](TestModel& test, std::size_t count, const char* type, int component) {
        test.json["accessors"].push_back({{"componentType", component}, {"count", count}, {"type", type}});
        return test.json["accessors"].size() - 1;
    };
    const auto with = [&](std::size_t count, const std::function<void(TestModel&, nlohmann::json&)>& more) {
        return [&zeros, count, more](TestModel& test) {
            nlohmann::json& primitive = test.json["meshes"][0]["primitives"][0];
            primitive = {{"attributes", {{"POSITION", zeros(test, count, "VEC3", 5126)}}}};
            more(test, primitive);
        };
    };
    const auto nothing = [](TestModel&, nlohmann::json&) {};
    expect("2000000 vertices of 72 bytes, ", with(2'000'000, nothing));
    expect("1560000 corners of 4 bytes, ", with(1'560'000, nothing));
    expect("1400000 corners of 12 bytes, ", with(1'400'000, nothing));
    expect("1000000 skinned vertices of 88 bytes, ", with(1'000'000, [&](TestModel& test, nlohmann::json& primitive) {
               primitive["attributes"]["JOINTS_0"] = zeros(test, 1'000'000, "VEC4", 5121);
               primitive["attributes"]["WEIGHTS_0"] = zeros(test, 1'000'000, "VEC4", 5126);
           }));
    expect("1000000 vertices of morph targets of 24 bytes, ",
           with(1'000'000, [](TestModel&, nlohmann::json& primitive) {
               const nlohmann::json target{{"POSITION", primitive["attributes"]["POSITION"]}};
               primitive["targets"] = {target, target};
           }));
}

TEST_F(SceneGltfRefuse, Indices) {
    expect("is 7, there are 3 vertices", [](TestModel& test) {
        test.json["meshes"][0]["primitives"][0]["indices"] = test.accessor<std::uint8_t>({0, 1, 7}, "SCALAR");
    });
    expect("/meshes/0/primitives/0/material: 4",
           [](TestModel& test) { test.json["meshes"][0]["primitives"][0]["material"] = 4; });
    expect("/meshes/0/primitives/0/attributes/POSITION: -1",
           [](TestModel& test) { test.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = -1; });
    expect("/nodes/0/mesh: 1", [](TestModel& test) { test.json["nodes"][0]["mesh"] = 1; });
    expect("/nodes/0/skin: 0", [](TestModel& test) { test.json["nodes"][0]["skin"] = 0; });
    expect("/scene: 5", [](TestModel& test) { test.json["scene"] = 5; });
    expect("has 1 elements, the others have 3", [](TestModel& test) {
        test.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = test.accessor<float>({0, 0, 1}, "VEC3");
    });
}

TEST_F(SceneGltfRefuse, CyclesAndSecondParents) {
    expect("node cycle 0 -> 1 -> 0", [](TestModel& test) {
        test.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
    });
    expect("node cycle 0 -> 0", [](TestModel& test) { test.json["nodes"] = {{{"children", {0}}}}; });
    expect("node 2 is a child of node 0 already", [](TestModel& test) {
        test.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, nlohmann::json::object()};
    });
    expect("twice", [](TestModel& test) { test.json["scenes"] = {{{"nodes", {0, 0}}}}; });
}

TEST_F(SceneGltfRefuse, RequiredExtensions) {
    for (const char* name : {"KHR_texture_basisu"})
        expect(name, [&](TestModel& test) { test.json["extensionsRequired"] = {name}; });
}

TEST_F(SceneGltfRefuse, ExtensionsThatAreNotReadAreToldOnce) {
    TestModel test;
    test.add_triangle();
    test.json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_lights_punctual", "ACME_smell",
                                   "KHR_materials_unlit"};
    put(file("model.gltf"), test.text());
    const auto model = read_model(file("model.gltf"));
    ASSERT_TRUE(model) << model.error().text;
    const std::vector<std::string> wanted{
        "/extensionsUsed/0: \"KHR_materials_transmission\" is not read here: glass is opaque",
        "/extensionsUsed/2: \"ACME_smell\" is not read here"};
    std::vector<std::string> told;
    for (const std::string& warning : model->warnings)
        if (warning.starts_with("/extensionsUsed")) told.push_back(warning);
    EXPECT_EQ(told, wanted);
}

TEST_F(SceneGltfRefuse, WaysOutOfTheFolder) {
    put(file("outside.bin"), std::string(64, '\0'));
    const fs::path inside = file("models");
    fs::create_directories(inside / "sub");
    fs::create_symlink(file("outside.bin"), inside / "link.bin");
    put(inside / "data file.bin", std::string(64, '\0'));
    put(inside / "Jot it 0.bin", std::string(64, '\0'));
    for (const std::string& uri :
         {std::string("../outside.bin"), file("outside.bin").string(), std::string("%2e%2e/outside.bin"),
          std::string("%2E%2E%2Foutside.bin"), std::string("sub/../../outside.bin"), std::string("..\\outside.bin"),
          std::string("link.bin"), "file://" + file("outside.bin").string(), std::string("http://host/outside.bin"),
          std::string("."), std::string("sub"), std::string("a%00b")}) {
        TestModel test;
        test.add_triangle();
        test.json["buffers"] = {{{"byteLength", test.bytes.size()}, {"uri", uri}}};
        put(inside / "model.gltf", test.text());
        const auto model = read_model(inside / "model.gltf");
        ASSERT_FALSE(model) << uri;
        EXPECT_NE(model.error().text.find("/buffers/0"), std::string::npos) << model.error().text;
    }
    for (const std::string& uri : {std::string("data%20file.bin"), std::string("data file.bin"),
                                   std::string("sub/../data%20file.bin"), std::string("./data file.bin"),
                                   // Every kind of digit, the first and the last ones.
                                   std::string("%4A%6ft %69%74 %30.bin"), std::string("%4a%6Ft%20it 0%2Ebin")}) {
        TestModel test;
        test.add_triangle();
        test.json["buffers"] = {{{"byteLength", test.bytes.size()}, {"uri", uri}}};
        put(inside / "model.gltf", test.text());
        const auto model = read_model(inside / "model.gltf");
        EXPECT_TRUE(model) << uri << ": " << model.error().text;
    }
}

TEST_F(SceneGltfRefuse, DeepJson) {
    put(file("deep.gltf"), std::string(100000, '['));
    EXPECT_FALSE(read_model(file("deep.gltf")));
    std::string extras = "0";
    for (int i = 0; i < 200; ++i) extras = "[" + extras + "]";
    put(file("model.gltf"), R"({"asset":{"version":"2.0","extras":)" + extras + "}}");
    const auto model = read_model(file("model.gltf"));
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().text.find("nested"), std::string::npos);
    put(file("model.gltf"), R"({"asset":{"version":"2.0","generator":")" + std::string(200, '[') + R"("}})");
    EXPECT_TRUE(read_model(file("model.gltf")));
}

TEST_F(SceneGltfRefuse, WordsOfTheJsonLibraryAreOurs) {
    for (const char* const text : {R"({"scene":1e400})", R"({"scene":})", "{\"a\":\"\xff\"}"}) {
        put(file("model.gltf"), text);
        const auto model = read_model(file("model.gltf"));
        ASSERT_FALSE(model);
        EXPECT_EQ(model.error().text.find("json.exception"), std::string::npos) << model.error().text;
        EXPECT_NE(model.error().text.find("is not JSON: "), std::string::npos) << model.error().text;
    }
}

TEST_F(SceneGltfRefuse, EveryCutOfAGlb) {
    const auto number = [](std::uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
    TestModel test;
    test.add_triangle();
    test.json["buffers"] = {{{"byteLength", test.bytes.size()}}};
    std::string json = test.json.dump();
    while (json.size() % 4 != 0) json += ' ';
    const std::string content = number(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
                                number(static_cast<std::uint32_t>(test.bytes.size())) + std::string("BIN\0", 4) +
                                test.bytes;
    const std::string glb = "glTF" + number(2) + number(static_cast<std::uint32_t>(content.size() + 12)) + content;
    const auto split = [](const std::string& text) {
        Budget budget;
        return gltf::split_container(std::as_bytes(std::span(text.data(), text.size())), budget).has_value();
    };
    ASSERT_TRUE(split(glb));
    for (std::size_t size = 0; size < glb.size(); ++size) EXPECT_FALSE(split(glb.substr(0, size))) << size;
    // The same with a header that agrees.
    for (std::size_t size = 12; size < glb.size(); ++size) {
        std::string cut = glb.substr(0, size);
        cut.replace(8, 4, number(static_cast<std::uint32_t>(size)));
        if (size != 20 + json.size()) {
            EXPECT_FALSE(split(cut)) << size;
        }
    }
    put(file("model.glb"), glb);
    EXPECT_TRUE(read_model(file("model.glb")));
}

// Every number of a file replaced by every awkward value: anything may come of it but a crash.
TEST_F(SceneGltfRefuse, AwkwardNumbersAnywhere) {
    TestModel test;
    auto& primitive = test.add_triangle();
    primitive["indices"] = test.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
    primitive["targets"] = {{{"POSITION", 0}}};
    test.json["nodes"].push_back({{"children", {0}}, {"rotation", {0, 0, 0, 1}}});
    test.json["scenes"] = {{{"nodes", {1}}}};
    test.json["materials"] = {{{"normalTexture", {{"index", 0}, {"scale", 1}}}}};
    test.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    test.json["samplers"] = {{{"wrapS", 10497}}};
    test.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    test.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 0}}};
    const std::size_t times = test.accessor<float>({0, 1}, "SCALAR");
    test.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                                {"samplers", {{{"input", times}, {"output", times}}}}}};
    static_cast<void>(test.text());
    const nlohmann::json flat = test.json.flatten();
    std::size_t tried = 0;
    for (const auto& [pointer, value] : flat.items()) {
        for (const nlohmann::json& awkward :
             {nlohmann::json(-1), nlohmann::json(2147483648), nlohmann::json(1e300), nlohmann::json(nullptr),
              nlohmann::json::array(), nlohmann::json::object(), nlohmann::json("x"), nlohmann::json(1)}) {
            nlohmann::json damaged = test.json;
            damaged[nlohmann::json::json_pointer(pointer)] = awkward;
            put(file("model.gltf"), damaged.dump());
            static_cast<void>(read_model(file("model.gltf")));
            ++tried;
        }
    }
    EXPECT_GT(tried, 300u);
}

}  // namespace
}  // namespace darkroom::scene
