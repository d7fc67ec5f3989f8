// SPDX-License-Identifier: MIT
#include "scene/packed/draco.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "image/test_files.hpp"
#include "scene/gltf/container.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/model.hpp"

namespace darkroom::scene {
namespace {

constexpr int side = 4;
constexpr std::uint64_t grid_triangles = 2ULL * side * side, grid_vertices = (side + 1ULL) * (side + 1);

// A square of 1x1 in the plane z = 0, whose colours say where they are, as the encoder of Draco 1.5.5 packs it with 10
// bits for a position and 8 for a normal. The encoder itself cannot be here: beside it the linker puts a TinyGLTF of
// its own.
constexpr const char* sequential_grid =
    "RFJBQ08CAgEAAAAgGQEAAQIAAgMBBAUBBQIEBgcEBwUGCAkGCQcDAgoDCgsCBQwCDAoFBw0FDQwHCQ4HDg0LCg8LDxAKDBEKEQ8MDRIMEhEN"
    "DhMNExIQDxQQFBUPERYPFhQREhcRFxYSExgSGBcBAwAJAwAKAQkDAAsCAgQBDAIDAQABAQECgAhpJv/////////zRQT5BWUJA5EC////////"
    "/+9pAxRPdkHqZVdvnoUuUcIKdA/ojpuxgAAAAAD/AwAAAAMBAQGAAbk+//dJAQMi357/AAAAfwAAAAABAQECD4UrIQU9CgORAu0BH6QViX+L"
    "gYCWymW3nAv/SAchGOdDQimMAAAAAP8AAAAAAAAAAAAAAAAAAAAAAIA/Cgg=";
constexpr const char* edgebreaker_grid =
    "RFJBQ08CAgEBAAAAGSACIAQACl/71FN9qlrVpwr/ARH/AsxC/wLMQgP/AAAAAAABAAABAAkDAAoCAQEJAwALAwECAgQBDAEBAQEACwOFK80M"
    "F5ECIQUGIlbNv95/AP4PAID+AfAfAAAkQAQAAQAEAgAhAAAAAP8DAAAAAAAAAAAAAAAAAAAAAIA/CgADAQEBgAG5Pv/3SQEDIt+e/wAAAH8A"
    "AAAIAQEBAQIPhTtJAe0BA6QjpAksU5n+47E0b4AAAAAA/wAAAA==";

struct PackedGrid {
    std::vector<std::uint8_t> bytes;
    std::uint32_t position = 10, normal = 11, color = 12;  // by their ids
};

PackedGrid pack_grid(const char* text) {
    const auto bytes = gltf::decode_data_uri(std::string("data:application/octet-stream;base64,") + text);
    EXPECT_TRUE(bytes);
    PackedGrid out;
    for (const std::byte byte : *bytes) out.bytes.push_back(std::to_integer<std::uint8_t>(byte));
    return out;
}

class ScenePackedDraco : public WithFolder {
  protected:
    static TestModel model_of(const PackedGrid& grid) {
        TestModel test;
        test.json["extensionsUsed"] = test.json["extensionsRequired"] = {extension};
        const auto accessor = [&](int type, std::uint64_t count, const char* shape) {
            test.json["accessors"].push_back({{"componentType", type}, {"count", count}, {"type", shape}});
        };
        accessor(5126, grid_vertices, "VEC3");
        accessor(5126, grid_vertices, "VEC3");
        accessor(5121, grid_vertices, "VEC4");
        test.json["accessors"][2]["normalized"] = true;
        accessor(5123, 3 * grid_triangles, "SCALAR");
        const nlohmann::json packed{
            {"bufferView", test.view(grid.bytes)},
            {"attributes", {{"POSITION", grid.position}, {"NORMAL", grid.normal}, {"COLOR_0", grid.color}}}};
        test.json["meshes"] = {{{"primitives",
                                 {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}}},
                                   {"indices", 3},
                                   {"extensions", {{extension, packed}}}}}}}};
        test.json["nodes"] = {{{"mesh", 0}}};
        return test;
    }
    Result<Model> read(TestModel& test) {
        put(file("model.gltf"), test.text());
        return read_model(file("model.gltf"));
    }
    void expect_refused(const char* part, const PackedGrid& grid, const std::function<void(TestModel&)>& damage = {}) {
        TestModel test = model_of(grid);
        if (damage) damage(test);
        const auto model = read(test);
        ASSERT_FALSE(model) << part;
        EXPECT_NE(model.error().text.find(part), std::string::npos) << model.error().text;
    }
    static constexpr const char* extension = "KHR_draco_mesh_compression";
};

TEST_F(ScenePackedDraco, AMeshIsWhatWasPackedByBothMethods) {
    for (const char* method : {sequential_grid, edgebreaker_grid}) {
        TestModel test = model_of(pack_grid(method));
        const auto model = read(test);
        ASSERT_TRUE(model) << model.error().text;
        EXPECT_TRUE(model->warnings.size() == 1) << model->warnings.size();  // positions without min and max
        const Primitive& primitive = model->meshes[0].primitives.at(0);
        EXPECT_EQ(primitive.vertices.size(), grid_vertices);
        ASSERT_EQ(primitive.indices.size(), 3 * grid_triangles);
        float area = 0;
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return primitive.vertices[primitive.indices[i + k]].position; };
            area += glm::cross(at(1) - at(0), at(2) - at(0)).z / 2;
        }
        EXPECT_NEAR(area, 1, 1e-3F);
        for (const Vertex& vertex : primitive.vertices) {
            EXPECT_NEAR(vertex.position.x * side, vertex.color.x * 255, 1e-2F);
            EXPECT_NEAR(vertex.position.y * side, vertex.color.y * 255, 1e-2F);
            EXPECT_FLOAT_EQ(vertex.color.z, 7 / 255.0F);
            EXPECT_LT(glm::length(vertex.normal - vec3(0, 0, 1)), 1e-2F);
        }
    }
}

TEST_F(ScenePackedDraco, PrimitivesOfOneShapeShareIt) {
    TestModel test = model_of(pack_grid(edgebreaker_grid));
    nlohmann::json& primitives = test.json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    const auto model = read(test);
    ASSERT_TRUE(model) << model.error().text;
    ASSERT_EQ(model->meshes[0].primitives.size(), 2U);
    EXPECT_EQ(model->meshes[0].primitives[1].vertices.size(), grid_vertices);
}

TEST_F(ScenePackedDraco, WhatIsNotAsItsAccessorsSayIsRefused) {
    for (const char* method : {sequential_grid, edgebreaker_grid}) {
        const PackedGrid grid = pack_grid(method);
        expect_refused("bufferView 0 has 32 triangles, accessor 3 has 93 corners", grid,
                       [](TestModel& test) { test.json["accessors"][3]["count"] = 93; });
        for (const int count : {12, 26})
            expect_refused("bufferView 0 has 25 vertices, its accessors have ", grid, [&](TestModel& test) {
                for (std::size_t i = 0; i < 3; ++i) test.json["accessors"][i]["count"] = count;
            });
        expect_refused("accessor 1 has 24 elements, the others have 25", grid,
                       [](TestModel& test) { test.json["accessors"][1]["count"] = 24; });
        expect_refused("attribute 11 has 3 components, its accessor has 4", grid,
                       [](TestModel& test) { test.json["accessors"][1]["type"] = "VEC4"; });
        PackedGrid other = grid;
        other.normal = 99;
        expect_refused("has no attribute 99", other);
        other.normal = 0xffffffff;
        expect_refused("attributes/NORMAL: 4294967295, a whole number, 0 to 2147483647, is needed", other);
        expect_refused("/mode: 5, only triangles (4) are unpacked", grid,
                       [](TestModel& test) { test.json["meshes"][0]["primitives"][0]["mode"] = 5; });
        expect_refused("/indices: is missing", grid,
                       [](TestModel& test) { test.json["meshes"][0]["primitives"][0].erase("indices"); });
    }
}

TEST_F(ScenePackedDraco, DamagedBytesAreRefused) {
    for (const char* method : {sequential_grid, edgebreaker_grid}) {
        const PackedGrid grid = pack_grid(method);
        const auto changed = [&](std::size_t at, std::uint8_t value) {
            PackedGrid out = grid;
            out.bytes[at] = value;
            return out;
        };
        expect_refused("is not a Draco mesh", changed(0, 'X'));
        expect_refused("is of version 2.1, 2.2 is read", changed(6, 1));
        expect_refused("has no triangles", changed(7, 0));
        expect_refused("has metadata, which is not read", changed(10, 0x80));
        PackedGrid cut = grid;
        cut.bytes.resize(12);
        expect_refused("is cut off in its head", cut);
        cut = grid;
        cut.bytes.resize(grid.bytes.size() / 2);
        expect_refused("is damaged", cut);
    }
}

// A head of a few bytes that claims 2^34 triangles, and one whose accessors claim them, too.
TEST_F(ScenePackedDraco, CountsOutOfProportionAreToldBeforeTheyAreMade) {
    PackedGrid grid = pack_grid(sequential_grid);
    const std::vector<std::uint8_t> huge{0xff, 0xff, 0xff, 0xff, 0x3f};
    grid.bytes.resize(11);
    for (int i = 0; i < 2; ++i) grid.bytes.insert(grid.bytes.end(), huge.begin(), huge.end());
    expect_refused("bufferView 0 has 17179869183 triangles, accessor 3 has 96 corners", grid);
    expect_refused("are left of the", grid, [](TestModel& test) {
        for (std::size_t i = 0; i < 3; ++i) test.json["accessors"][i]["count"] = 17179869183;
        test.json["accessors"][3]["count"] = 3 * 17179869183;
    });
}

TEST_F(ScenePackedDraco, AttributesAreDeclaredBeforeThereIsRoomForThem) {
    for (const char* method : {sequential_grid, edgebreaker_grid}) {
        const PackedGrid grid = pack_grid(method);
        std::uint64_t admitted = 0;
        const auto refuse = [&](std::uint64_t vertices, std::uint64_t bytes) -> Result<> {
            EXPECT_EQ(vertices, grid_vertices);
            admitted = bytes;
            return user_error("no room");
        };
        std::vector<std::uint32_t> corners;
        const auto unpacked = unpack_draco(std::as_bytes(std::span(grid.bytes)), grid_vertices, refuse, {}, corners);
        ASSERT_FALSE(unpacked);
        EXPECT_EQ(unpacked.error().text, "no room");
        EXPECT_EQ(admitted, 2 * (3 * 12U + 4) + 4 * 9U + 4);
    }
}

TEST_F(ScenePackedDraco, NoDamageEndsTheProgram) {
    std::mt19937 random(7);
    int refused = 0;
    for (const char* method : {sequential_grid, edgebreaker_grid}) {
        const PackedGrid grid = pack_grid(method);
        for (int round = 0; round < 1500; ++round) {
            std::vector<std::uint8_t> bytes = grid.bytes;
            for (int i = 0; i < 1 + round % 4; ++i)
                bytes[11 + random() % (bytes.size() - 11)] = static_cast<std::uint8_t>(random());
            const auto head = read_draco_head(std::as_bytes(std::span(bytes)));
            if (!head || head->triangles != grid_triangles || head->vertices > grid_vertices) continue;
            std::array<DracoAttribute, 1> wanted{DracoAttribute{.id = grid.position, .components = 3}};
            std::vector<std::uint32_t> corners;
            const auto admit = [](std::uint64_t, std::uint64_t each) -> Result<> {
                return each < 4096 ? Result<>() : user_error("too much");
            };
            const auto unpacked = unpack_draco(std::as_bytes(std::span(bytes)), grid_vertices, admit, wanted, corners);
            refused += unpacked ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace darkroom::scene
