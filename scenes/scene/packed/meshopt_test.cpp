// SPDX-License-Identifier: MIT
#include "scene/packed/meshopt.hpp"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "image/test_files.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

using PackedBytes = std::vector<std::uint8_t>;

template <class T>
PackedBytes pack_attributes(const std::vector<T>& values, std::size_t stride) {
    const std::size_t count = values.size() * sizeof(T) / stride;
    PackedBytes out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
    return out;
}

PackedBytes pack_triangles(const std::vector<unsigned>& corners, std::size_t vertices) {
    PackedBytes out(meshopt_encodeIndexBufferBound(corners.size(), vertices));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), corners.data(), corners.size()));
    return out;
}

PackedBytes pack_indices(const std::vector<unsigned>& indices, std::size_t vertices) {
    PackedBytes out(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

template <class T>
std::vector<T> unpacked(const PackedBytes& packed, const MeshoptDesc& desc) {
    EXPECT_TRUE(check_meshopt(desc));
    const auto bytes = unpack_meshopt(std::as_bytes(std::span(packed)), desc);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().text);
    std::vector<T> out(bytes ? bytes->size() / sizeof(T) : 0);
    if (bytes) std::memcpy(out.data(), bytes->data(), bytes->size());
    return out;
}

/// Unit vectors of four numbers, of which one may be 0.
std::vector<float> unit_vectors(std::size_t count, bool has_fourth) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        const vec4 direction =
            glm::normalize(vec4(normal(random), normal(random), normal(random), has_fourth ? normal(random) : 0.0F));
        for (int c = 0; c < 4; ++c) out.push_back(direction[c]);
    }
    return out;
}

TEST(ScenePackedMeshopt, ModesGiveWhatWasPacked) {
    const std::vector<float> values{0, 1, 2, -3, 4.5F, 1e9F, 7, 8, 9, 1, 1, 1};
    EXPECT_EQ(unpacked<float>(pack_attributes(values, 12), {.count = 4, .stride = 12}), values);
    const std::vector<unsigned> corners{0, 1, 2, 2, 1, 3};
    EXPECT_EQ(
        unpacked<std::uint32_t>(pack_triangles(corners, 4), {.mode = MeshoptMode::Triangles, .count = 6, .stride = 4}),
        corners);
    EXPECT_EQ(
        unpacked<std::uint16_t>(pack_triangles(corners, 4), {.mode = MeshoptMode::Triangles, .count = 6, .stride = 2}),
        (std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}));
    const std::vector<unsigned> line{0, 1, 1, 70000, 2};
    EXPECT_EQ(
        unpacked<std::uint32_t>(pack_indices(line, 70001), {.mode = MeshoptMode::Indices, .count = 5, .stride = 4}),
        line);
}

TEST(ScenePackedMeshopt, FiltersGiveWhatWasPacked) {
    constexpr std::size_t count = 37;
    const std::vector<float> normals = unit_vectors(count, false);
    std::vector<std::int8_t> bytes(count * 4);
    meshopt_encodeFilterOct(bytes.data(), count, 4, 8, normals.data());
    std::vector<std::int16_t> words(count * 4);
    meshopt_encodeFilterOct(words.data(), count, 8, 12, normals.data());
    const auto octahedral8 = unpacked<std::int8_t>(pack_attributes(bytes, 4),
                                                   {.filter = MeshoptFilter::Octahedral, .count = count, .stride = 4});
    const auto octahedral16 = unpacked<std::int16_t>(
        pack_attributes(words, 8), {.filter = MeshoptFilter::Octahedral, .count = count, .stride = 8});
    for (std::size_t i = 0; i < count * 4; ++i) {
        EXPECT_NEAR(octahedral8.at(i) / 127.0F, normals[i], 0.02F) << i;
        EXPECT_NEAR(octahedral16.at(i) / 32767.0F, normals[i], 0.002F) << i;
    }

    const std::vector<float> turns = unit_vectors(count, true);
    meshopt_encodeFilterQuat(words.data(), count, 8, 12, turns.data());
    const auto quaternions = unpacked<std::int16_t>(pack_attributes(words, 8),
                                                    {.filter = MeshoptFilter::Quaternion, .count = count, .stride = 8});
    for (std::size_t i = 0; i < count; ++i) {
        float along = 0;
        for (std::size_t c = 0; c < 4; ++c) along += quaternions.at(i * 4 + c) / 32767.0F * turns[i * 4 + c];
        EXPECT_NEAR(std::abs(along), 1, 1e-3F) << i;
    }

    std::vector<std::uint32_t> exponents(count * 3);
    const std::vector<float> numbers(normals.begin(), normals.begin() + count * 3);
#if MESHOPTIMIZER_VERSION >= 190
    meshopt_encodeFilterExp(exponents.data(), count, 12, 15, numbers.data(), meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(exponents.data(), count, 12, 15, numbers.data());
#endif
    const auto exponential = unpacked<float>(pack_attributes(exponents, 12),
                                             {.filter = MeshoptFilter::Exponential, .count = count, .stride = 12});
    for (std::size_t i = 0; i < count * 3; ++i) EXPECT_NEAR(exponential.at(i), numbers[i], 1e-3F) << i;
}

class ScenePackedMeshoptModel : public WithFolder {
  protected:
    /// A square of 2x2 with normals, of which nothing is there but what is packed.
    static TestModel square() {
        TestModel test;
        test.json["extensionsUsed"] = test.json["extensionsRequired"] = {extension, "KHR_mesh_quantization"};
        const std::vector<float> positions{0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0};
        std::vector<std::int8_t> normals(16);
        const std::vector<float> up{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
        meshopt_encodeFilterOct(normals.data(), 4, 4, 8, up.data());
        add(test, pack_attributes(positions, 12), 4, 12, "ATTRIBUTES", "NONE");
        add(test, pack_attributes(normals, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
        add(test, pack_triangles({0, 1, 2, 2, 1, 3}, 4), 6, 2, "TRIANGLES", "NONE");
        const auto accessor = [&](std::size_t view, int type, int count, const char* shape) {
            test.json["accessors"].push_back(
                {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
        };
        accessor(0, 5126, 4, "VEC3");
        accessor(1, 5120, 4, "VEC3");
        test.json["accessors"][1]["normalized"] = true;
        accessor(2, 5123, 6, "SCALAR");
        test.json["accessors"][0]["min"] = {0, 0, 0};
        test.json["accessors"][0]["max"] = {2, 2, 0};
        test.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}}}}}};
        test.json["nodes"] = {{{"mesh", 0}}};
        return test;
    }
    Result<Model> read(TestModel& test) {
        static_cast<void>(test.text());  // puts its bytes into the first buffer
        test.json["buffers"].push_back(
            {{"byteLength", 1ULL << 33U}, {"extensions", {{extension, {{"fallback", true}}}}}});
        put(file("model.gltf"), test.json.dump());
        return read_model(file("model.gltf"));
    }
    void expect_refused(const char* part, const std::function<void(TestModel&)>& damage) {
        TestModel test = square();
        damage(test);
        const auto model = read(test);
        ASSERT_FALSE(model) << part;
        EXPECT_NE(model.error().text.find(part), std::string::npos) << model.error().text;
    }
    static nlohmann::json& packed(TestModel& test, std::size_t view) {
        return test.json["bufferViews"][view]["extensions"][extension];
    }
    static constexpr const char* extension = "EXT_meshopt_compression";

  private:
    static void add(TestModel& test, const PackedBytes& bytes, std::size_t count, std::size_t stride, const char* mode,
                    const char* filter) {
        nlohmann::json& view = test.json["bufferViews"][test.view(bytes)];
        const nlohmann::json from = view;
        view["extensions"][extension] = {{"buffer", 0},
                                         {"byteOffset", from["byteOffset"]},
                                         {"byteLength", from["byteLength"]},
                                         {"byteStride", stride},
                                         {"count", count},
                                         {"mode", mode},
                                         {"filter", filter}};
        view["buffer"] = 1;
        view["byteOffset"] = 0;
        view["byteLength"] = count * stride;
        if (mode == std::string_view("ATTRIBUTES")) view["byteStride"] = stride;
    }
};

TEST_F(ScenePackedMeshoptModel, AMeshIsWhatWasPacked) {
    TestModel test = square();
    const auto model = read(test);
    ASSERT_TRUE(model) << model.error().text;
    EXPECT_TRUE(model->warnings.empty()) << model->warnings[0];
    const Primitive& primitive = model->meshes[0].primitives.at(0);
    ASSERT_EQ(primitive.vertices.size(), 4U);
    EXPECT_EQ(primitive.vertices[3].position, vec3(2, 2, 0));
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
    for (const Vertex& vertex : primitive.vertices) EXPECT_LT(glm::length(vertex.normal - vec3(0, 0, 1)), 1e-2F);
}

TEST_F(ScenePackedMeshoptModel, WhatIsNotAsItIsSaidIsRefused) {
    const auto with = [&](std::size_t view, const char* key, const nlohmann::json& value) {
        return [=](TestModel& test) { packed(test, view)[key] = value; };
    };
    expect_refused(R"(/bufferViews/0/extensions/EXT_meshopt_compression/mode: "SQUARES", allowed is ATTRIBUTES, TRI)",
                   with(0, "mode", "SQUARES"));
    expect_refused(R"(filter: "SEPIA", allowed is NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL)",
                   with(1, "filter", "SEPIA"));
    expect_refused("byteStride: 6, allowed is a multiple of 4", with(0, "byteStride", 6));
    expect_refused("byteStride: 12, allowed is 4 or 8 for OCTAHEDRAL", with(0, "filter", "OCTAHEDRAL"));
    expect_refused("byteStride: 12, allowed is 8 for QUATERNION", with(0, "filter", "QUATERNION"));
    expect_refused("byteStride: 8, allowed is 2 or 4 for indices", with(2, "byteStride", 8));
    expect_refused("filter: only ATTRIBUTES have one", with(2, "filter", "EXPONENTIAL"));
    expect_refused("count: 5, a multiple of 3 is needed for TRIANGLES", with(2, "count", 5));
    expect_refused("count: -1, a whole number", with(2, "count", -1));
    expect_refused("byteLength: 48, 5 elements of 12 bytes are packed", with(0, "count", 5));
    expect_refused("/bufferViews/0/byteStride: 16, that of what is packed is 12",
                   [](TestModel& test) { test.json["bufferViews"][0]["byteStride"] = 16; });
    expect_refused("bytes 9000 to ", with(0, "byteOffset", 9000));
    expect_refused("buffer: 2, there are 2 buffers", with(0, "buffer", 2));
    expect_refused("packed bytes that are not 4 elements of 12 bytes", with(0, "byteLength", 20));
    expect_refused("bytes 0 to 48, buffer 1 has 0",
                   [](TestModel& test) { test.json["bufferViews"][0].erase("extensions"); });
}

TEST_F(ScenePackedMeshoptModel, CountsOutOfProportionAreToldBeforeTheyAreMade) {
    expect_refused("1099511627776 elements of 12 bytes", [](TestModel& test) {
        packed(test, 0)["count"] = 1ULL << 40U;
        test.json["bufferViews"][0]["byteLength"] = 1ULL << 40U;
    });
}

TEST(ScenePackedMeshopt, NoDamageEndsTheProgram) {
    std::mt19937 random(11);
    const PackedBytes attributes = pack_attributes(unit_vectors(100, true), 16);
    const PackedBytes triangles = pack_triangles({0, 1, 2, 2, 1, 3, 3, 1, 4, 9, 8, 7}, 10);
    const PackedBytes indices = pack_indices({0, 1, 2, 2, 1, 3, 3, 1, 4, 9, 8, 7}, 10);
    const std::array<std::pair<const PackedBytes*, MeshoptDesc>, 3> files{
        {{&attributes, {.count = 100, .stride = 16}},
         {&triangles, {.mode = MeshoptMode::Triangles, .count = 12, .stride = 2}},
         {&indices, {.mode = MeshoptMode::Indices, .count = 12, .stride = 4}}}};
    int refused = 0;
    for (const auto& [packed, desc] : files)
        for (int round = 0; round < 1000; ++round) {
            PackedBytes bytes = *packed;
            if (round % 2 == 0) bytes.resize(random() % bytes.size());
            for (int i = 0; !bytes.empty() && i < 1 + round % 4; ++i)
                bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
            const auto out = unpack_meshopt(std::as_bytes(std::span(bytes)), desc);
            EXPECT_TRUE(!out || out->size() == desc.count * desc.stride);
            refused += out ? 0 : 1;
        }
    EXPECT_GT(refused, 1400);
}

}  // namespace
}  // namespace darkroom::scene
