// SPDX-License-Identifier: MIT
// `darkroom info`: what it tells of every kind of file, and that one it cannot read hides no other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects.hpp>
#include <darkroom/frame.hpp>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "core/text/param_text.hpp"
#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using test::Outcome;

class CliInfo : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(6, 4);
        frame.color.at(2, 1)[0] = 7.5f;
        frame.depth = Plane<1>(6, 4);
        std::fill(frame.depth->values.begin(), frame.depth->values.end(), 3.0f);
        frame.camera.world_to_camera = Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, -2, -5, 1};
        frame.camera.projection = perspective(40, 1.5);
        frame.camera.far_distance = std::numeric_limits<float>::infinity();
        frame.camera.jitter = {0.25F, -0.375F};
        frame.time = 2.5;
        frame.frame_index = 60;
        FrameCascade cascade{.split = 25, .depth = Plane<1>(16, 16)};
        frame.lights = {{.color = {3, 2, 1}, .volumetric_intensity = 0.5f, .cascades = {cascade, cascade}}, {}};
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        ASSERT_TRUE(write_picture(path("picture.png"), Picture(5, 3)));
        write("look.toml", "[post_process]\nenabled = true\n");
        write("room.scene.toml",
              "[scene]\nname = \"Room\"\n[camera]\nposition = [1, 2, 3]\n[entities.lamp.light]\ntype = \"point\"\n"
              "intensity = 4\n[entities.box]\nbounds = { min = [0, 0, 0], max = [1, 1, 1] }\n"
              "[entities.smoke.particle_emitter]\nmax_particles = 12\n[post_process]\n");
        write("model.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"name": "a"}, {"name": "b"}],
            "scenes": [{"nodes": [0, 1]}], "materials": [{"name": "paint", "alphaMode": "BLEND"}]})");
    }
    [[nodiscard]] json document(const std::string& file) const {
        const Outcome outcome = run({"info", file, "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        json found = json::parse(outcome.out, nullptr, false);
        EXPECT_TRUE(found.is_object()) << outcome.out;
        EXPECT_EQ(found.value("file", ""), file);
        return found;
    }
    [[nodiscard]] static double middle(const ParamInfo& row) { return (row.range.min + row.range.max) / 2; }
    [[nodiscard]] static json layer(const json& document, const std::string& name) {
        for (const json& row : document.at("layers"))
            if (row.at("layer") == name) return row;
        ADD_FAILURE() << name << " is not in " << document.dump();
        return json::object();
    }
};

TEST_F(CliInfo, AFrameIsToldWithLayersCameraAndLights) {
    const json found = document(path("frame.exr"));
    EXPECT_EQ(found.at("kind"), "frame");
    EXPECT_EQ(found.at("format"), "OpenEXR");
    EXPECT_EQ(found.at("size"), json({6, 4}));
    EXPECT_EQ(found.at("parts").at(0).at("compression"), "zip");
    EXPECT_EQ(layer(found, "color").at("max"), 7.5);
    EXPECT_EQ(layer(found, "color").at("samples"), "half");
    EXPECT_EQ(layer(found, "depth").at("channels"), json({"Z"}));
    EXPECT_EQ(layer(found, "depth").at("min"), 3.0);
    EXPECT_EQ(layer(found, "shadow0").at("channels"), json({"cascade0", "cascade1"}));
    EXPECT_EQ(found.at("camera").at("position"), json({1.0, 2.0, 5.0}));
    EXPECT_EQ(found.at("camera").at("direction"), json({0.0, 0.0, -1.0}));
    EXPECT_NEAR(found.at("camera").at("vertical_field_of_view_degrees").get<double>(), 40, 1e-4);
    EXPECT_EQ(found.at("camera").at("far"), "inf");
    EXPECT_EQ(found.at("camera").at("jitter"), json({0.25, -0.375}));
    EXPECT_EQ(found.at("time"), 2.5);
    EXPECT_EQ(found.at("frame_index"), 60);
    ASSERT_EQ(found.at("lights").size(), 2u);
    EXPECT_EQ(found.at("lights").at(0).at("cascades"), 2);
    EXPECT_EQ(found.at("lights").at(0).at("reach"), 25.0);
    EXPECT_EQ(found.at("lights").at(1).at("cascades"), 0);
}

// Of frames that were drawn for effects that gather them.
TEST_F(CliInfo, JitterThatWasLeftInMotionIsToldAsAWarning) {
    for (const bool is_left : {false, true}) {
        FrameFile frame;
        frame.color = Picture(16, 9);
        frame.depth = Plane<1>(16, 9);
        std::ranges::fill(frame.depth->values, 5.0F);
        frame.velocity = Plane<2>(16, 9);
        frame.camera.world_to_camera = frame.camera.previous_world_to_camera =
            Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        frame.camera.jitter = {0.25F, -0.375F};
        frame.camera.previous_jitter = {-0.25F, 0.125F};
        const Matrix lens = perspective(40, 16 / 9.0);
        frame.camera.projection = jittered(lens, *frame.camera.jitter, {16, 9});
        frame.camera.previous_projection = jittered(lens, *frame.camera.previous_jitter, {16, 9});
        for (std::size_t i = 0; is_left && i < frame.velocity->values.size(); ++i)
            frame.velocity->values[i] = i % 2 == 0 ? -0.5F : 0.5F;
        ASSERT_TRUE(write_frame(path("jittered.exr"), frame));
        const json found = document(path("jittered.exr"));
        if (!is_left) {
            EXPECT_FALSE(found.contains("warnings")) << found.dump();
            continue;
        }
        ASSERT_EQ(found.at("warnings").size(), 1U) << found.dump();
        EXPECT_EQ(
            found.at("warnings").at(0),
            "velocity: holds the jitter, which camera.velocity.has_jitter does not say: what stands still moves by "
            "-0.500, 0.500 pixels");
    }
}

TEST_F(CliInfo, WhatTheDefaultLookLeavesOutIsThePlansWord) {
    const json with = document(path("frame.exr")).at("default_look"),
               without = document(path("picture.png")).at("default_look");
    const std::string plan = run({"plan", "--ssao", "--input", path("picture.png")}).out;
    const auto count = [](const json& look) {
        return look.at("left_out").size() + look.at("would_be_left_out_if_on").size();
    };
    EXPECT_GT(count(without), count(with));
    EXPECT_TRUE(without.at("left_out").empty()) << "nothing of it is on by itself for files";
    for (const json& line : without.at("would_be_left_out_if_on"))
        EXPECT_NE(plan.find("left out: " + line.get<std::string>() + "\n"), std::string::npos) << plan;
}

TEST_F(CliInfo, WhatIsNoNumberIsCountedByLayer) {
    std::vector<float> values(32, 0.25f);
    values[1] = values[6] = std::numeric_limits<float>::quiet_NaN();
    values[3] = -std::numeric_limits<float>::infinity();
    test::store_floats(path("nan.exr"), {"R", "G", "B", "Z"}, 4, values);
    const json found = document(path("nan.exr"));
    EXPECT_EQ(layer(found, "color").at("nan"), 2);
    EXPECT_EQ(layer(found, "color").at("infinite"), 0);
    EXPECT_EQ(layer(found, "color").at("max"), 0.25);
    EXPECT_EQ(layer(found, "depth").at("infinite"), 1);
}

TEST_F(CliInfo, ScenesLooksAndModelsAreToldByTheirTables) {
    const json scene = document(path("room.scene.toml"));
    EXPECT_EQ(scene.at("kind"), "scene");
    EXPECT_EQ(scene.at("name"), "Room");
    EXPECT_EQ(scene.at("entities"), 3);
    EXPECT_EQ(scene.at("boxes"), 1);
    EXPECT_EQ(scene.at("camera").at("position"), json({1.0, 2.0, 3.0}));
    EXPECT_EQ(scene.at("lights").at(0).at("type"), "point");
    EXPECT_EQ(scene.at("particles").at(0).at("at_most"), 12);
    EXPECT_EQ(scene.at("look").at("form"), "[post_process]");
    const json model = document(path("model.gltf"));
    EXPECT_EQ(model.at("kind"), "model");
    EXPECT_EQ(model.at("nodes"), 2);
    EXPECT_EQ(model.at("materials").at(0).at("blend"), "alpha");
}

TEST_F(CliInfo, ALookIsItsEntriesWithWhatIsTheirOwn) {
    EXPECT_EQ(document(path("look.toml")).at("kind"), "look");
    // Of every effect there is the first number, halfway to the end of its range.
    std::string text;
    std::vector<std::pair<const EffectInfo*, const ParamInfo*>> written;
    for (const EffectInfo* const effect : all_effects()) {
        const auto row = std::ranges::find(effect->parameters.rows, Kind::Float, &ParamInfo::kind);
        if (effect->conflict != nullptr || row == effect->parameters.rows.end()) continue;
        text += fmt::format("[[stack]]\neffect = \"{}\"\n{} = {}\n", effect->name, row->name, middle(*row));
        written.emplace_back(effect, &*row);
    }
    const json look = document(write("stack.toml", text));
    EXPECT_EQ(look.at("form"), "[[stack]]");
    ASSERT_EQ(look.at("entries").size(), written.size());
    for (std::size_t i = 0; i < written.size(); ++i) {
        const auto [effect, row] = written[i];
        const json& entry = look.at("entries").at(i);
        EXPECT_EQ(entry.at("effect"), effect->name);
        std::vector<std::uint32_t> words(effect->parameters.defaults.begin(), effect->parameters.defaults.end());
        ASSERT_TRUE(assign(*row, words, middle(*row)));
        const bool is_default = std::ranges::equal(words, effect->parameters.defaults);
        ASSERT_EQ(entry.at("values").size(), is_default ? 0u : 1u) << "what differs, alone: " << entry.dump();
        if (!is_default) {
            EXPECT_NEAR(entry.at("values").at(std::string(row->name)).get<double>(), middle(*row),
                        1e-6 * std::abs(middle(*row)));
        }
    }
}

TEST_F(CliInfo, TheKindIsToldByContent) {
    for (const auto& [from, to, kind] :
         {std::tuple("frame.exr", "a.png", "frame"), std::tuple("picture.png", "a", "picture"),
          std::tuple("model.gltf", "a.txt", "model"), std::tuple("look.toml", "b", "look")}) {
        fs::copy_file(path(from), path(to));
        EXPECT_EQ(document(path(to)).at("kind"), kind);
    }
}

TEST_F(CliInfo, ABadFileIsOneLineAndHidesNoOther) {
    write("bad.exr", "\x76\x2f\x31\x01 and no more");
    const std::vector<std::string> bad{write("bytes", "nothing known"),
                                       write("bad.toml", "[entities"),
                                       write("other.toml", "[package]\nname = 1\n"),
                                       write("bad.glb", "glTFxxxx"),
                                       path("bad.exr"),
                                       path("none.exr"),
                                       path("")};
    for (const std::string& file : bad) expect_refused({"info", file}, 1, file);
    std::vector<std::string> arguments{"info", path("look.toml")};
    arguments.insert(arguments.end(), bad.begin(), bad.end());
    arguments.insert(arguments.end(), {path("picture.png"), "--json"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), static_cast<std::ptrdiff_t>(bad.size()));
    const json documents = json::parse(outcome.out, nullptr, false);
    ASSERT_TRUE(documents.is_array()) << outcome.out;
    EXPECT_EQ(documents.size(), 2u);
}

TEST_F(CliInfo, TheTextIsAlignedAndOnOneLineEach) {
    const Outcome outcome = run({"info", path("frame.exr"), path("look.toml")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* const line : {"\nkind         frame\n", "\nsize         6 x 4\n", "\nframe index  60\n",
                                   "\n  projection                      perspective\n", "\n\nfile     "})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << " is not in\n" << outcome.out;
    // The columns of a table begin below their heads.
    const std::size_t head = outcome.out.find("  layer "), row = outcome.out.find("  depth ", head);
    ASSERT_TRUE(head != std::string::npos && row != std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find("samples", head) - head, outcome.out.find("float", row) - row) << outcome.out;
}

TEST_F(CliInfo, NoDeviceIsOpened) {
    for (const char* const name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) ::setenv(name, "/none", 1);
    const int without = run({"devices"}).code;
    const Outcome outcome = run({"info", path("frame.exr"), path("room.scene.toml")});
    for (const char* const name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) ::unsetenv(name);
    EXPECT_EQ(without, 2) << "there was a driver";
    EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(CliInfo, ExamplesOfEveryKindAreTold) {
    const char* const data = std::getenv("DARKROOM_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const std::string folder = std::string(data) + "/";
    // Triangles and vertices are those that Khronos publishes of its sample.
    const json man = document(folder + "models/CesiumMan.glb");
    EXPECT_EQ(man.at("triangles"), 4672);
    EXPECT_EQ(man.at("vertices"), 3273);
    EXPECT_EQ(man.at("joints"), 19);
    EXPECT_EQ(man.at("animations").at(0).at("seconds"), 2.0);
    EXPECT_EQ(man.at("textures").at(0).at("size"), json({1024, 1024}));
    const json blender = document(folder + "exr/render_interior/interior.0022.exr");
    EXPECT_EQ(blender.at("kind"), "frame");
    EXPECT_EQ(layer(blender, "normals").at("channels").at(0), "ViewLayer.Normal.X");
    const json stereo = document(folder + "exr/beachball/multipart.0001.exr");
    EXPECT_EQ(stereo.at("parts").size(), 10u);
    EXPECT_EQ(stereo.at("parts").at(0).at("data_offset"), json({654, 245}));
    const json rings = document(folder + "exr/testimages/BrightRingsNanInf.exr");
    EXPECT_EQ(layer(rings, "color").at("nan"), 6);
    EXPECT_EQ(layer(rings, "color").at("infinite"), 12);
    EXPECT_EQ(document(folder + "flip/ldr/reference.png").at("format"), "PNG");
    for (const std::string name : {"/scenes/dungeon.scene.toml", "/looks/bright.toml"})
        EXPECT_EQ(document(test::source_folder + name).at("kind"), name.starts_with("/scenes") ? "scene" : "look");
}

}  // namespace
}  // namespace darkroom
