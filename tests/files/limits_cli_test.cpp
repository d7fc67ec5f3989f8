// SPDX-License-Identifier: MIT
// docs/limits.md, row by row: for a figure a file is made that is one beyond it, which has to be refused or told in one
// line, and where that is cheap one that is just within it. Rows that other tests hold are named with these.
#include <fmt/format.h>

#include <regex>
#include <set>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::Outcome;
using Words = std::vector<std::string>;

class CliLimits : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(8, 8);
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        page_ = test::content(std::filesystem::path(test::source_folder) / "docs/limits.md");
    }
    /// That the page has a row that begins so, figures included.
    void expect_row(const std::string& start) const {
        EXPECT_NE(page_.find("\n| " + start), std::string::npos) << "docs/limits.md has no row: " << start;
    }
    void expect_told(const Words& typed, int code, const std::string& part) const {
        const Outcome outcome = run(typed);
        EXPECT_EQ(outcome.code, code) << part << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in " << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    void expect_silent(const Words& typed, const std::string& part) const {
        const Outcome outcome = run(typed);
        EXPECT_EQ(outcome.err.find(part), std::string::npos) << outcome.err.substr(0, 300);
        EXPECT_EQ(outcome.code, 0) << outcome.err.substr(0, 300);
    }
    [[nodiscard]] Words drawn(const std::string& text) const {
        return {"render", write("a.scene.toml", text), "--size", "8x8", "-q", "-o", path("out.png")};
    }
    /// A file of this length that takes no room.
    [[nodiscard]] std::string sparse(const std::string& name, const std::string& start, std::uintmax_t size) const {
        write(name, start);
        std::filesystem::resize_file(path(name), size);
        return path(name);
    }
    static std::string repeated(std::size_t count, const std::function<std::string(std::size_t)>& part) {
        std::string out;
        for (std::size_t i = 0; i < count; ++i) out += part(i);
        return out;
    }
    static std::string repeated(std::size_t count, const std::string& part) {
        return repeated(count, [&](std::size_t) { return part; });
    }

    std::string page_;
};

constexpr std::uintmax_t mebibyte = 1 << 20, gibibyte = 1 << 30;

TEST_F(CliLimits, LengthsOfFiles) {
    const auto refused = [&](const Words& typed, std::uintmax_t most) {
        expect_told(typed, 1, fmt::format(": {} bytes, at most {} are read", most + 1, most));
    };
    const std::string out = path("out.png");
    expect_row("an image file | 4 GiB;");
    refused({"develop", sparse("a.exr", "\x76\x2f\x31\x01", 4 * gibibyte + 1), "-o", out}, 4 * gibibyte);
    expect_row(
        "`.cube`; other tables, with all that they name, one that is named twice counted twice | 1 GiB; 32 MiB,");
    refused({"lut", "info", sparse("a.cube", "", gibibyte + 1)}, gibibyte);
    refused({"lut", "info", sparse("a.clf", "", 32 * mebibyte + 1)}, 32 * mebibyte);
    expect_row("bytes of all files of a model | 4 GiB |");
    refused({"render", sparse("a.glb", "glTF", 4 * gibibyte + 1), "-o", out}, 4 * gibibyte);
    expect_row("an SVG document, its values in place | 1 MiB, 20000 elements, 200 in one another |");
    refused({"develop", path("frame.exr"), "--ui", sparse("a.svg", "", mebibyte + 1), "-o", out}, mebibyte);
    expect_row("scene, prefab, look or camera file | 4 MiB |");
    const std::string long_toml = sparse("a.toml", "", 4 * mebibyte + 1);
    refused({"render", long_toml, "-o", out}, 4 * mebibyte);
    refused({"develop", path("frame.exr"), "--look", long_toml, "-o", out}, 4 * mebibyte);
    refused({"develop", path("frame.exr"), "--camera", long_toml, "-o", out}, 4 * mebibyte);
    const std::string scene = "[scene]\n";
    expect_silent(drawn(scene + std::string(4 * mebibyte - scene.size(), '\n')), "bytes");
    expect_row("file | 64 KiB, a regular one |");
    refused({"effects", sparse("a.glsl", "", 65537)}, 65536);
}

TEST_F(CliLimits, TextsOfScenes) {
    expect_row("nesting of values; dots of one line; dots of all keys | 16; 64; 262144 |");
    expect_told(drawn("[scene]\nx = " + std::string(17, '[') + std::string(17, ']') + "\n"), 1,
                "exceeded maximum nested value depth of 16");
    expect_silent(drawn("[scene]\nx = " + std::string(15, '[') + std::string(15, ']') + "\n"), "nested");
    expect_told(drawn(repeated(65, "a.") + "a = 1\n"), 1, "the line holds more than 64 dots");
    expect_row("entities, prefabs, prefabs in each other | 100000, 10000, 16 |");
    expect_told(drawn(repeated(100001, [](std::size_t i) { return fmt::format("[entities.a{}]\n", i); })), 1,
                "a.scene.toml:100001:11: the scene has more than 100000 entities");
    const std::string thing = "[templates.t0.entities.x]\n";
    const auto prefabs = [&](std::size_t count) {
        return thing +
               repeated(count, [](std::size_t i) { return fmt::format("[prefabs.a{}]\ntemplate = \"t0\"\n", i); });
    };
    expect_told(drawn(prefabs(10001)), 1, "the scene has more than 10000 prefabs");
    expect_silent(drawn(prefabs(10000)), "more than");
    const auto nested = [&](std::size_t depth) {
        return thing +
               repeated(depth - 1,
                        [](std::size_t i) {
                            return fmt::format("[templates.t{}.prefabs.p]\ntemplate = \"t{}\"\n", i + 1, i);
                        }) +
               fmt::format("[prefabs.z]\ntemplate = \"t{}\"\n", depth - 1);
    };
    expect_told(drawn(nested(17)), 1, "prefabs go deeper than 16");
    expect_silent(drawn(nested(16)), "deeper");
    expect_row("particles of an emitter | 10000 |");
    const std::string emitter = "[entities.a.particle_emitter]\nmax_particles = ";
    expect_told(drawn(emitter + "10001\n"), 0, "max_particles = 10001: allowed is [0, 10000]");
    expect_silent(drawn(emitter + "10000\n"), "allowed");
    expect_row("lights that are drawn: directional, point, spot | 4, 16, 8; others are left out with a warning |");
    for (const auto& [kind, most] : {std::pair("directional", 4U), std::pair("point", 16U), std::pair("spot", 8U)}) {
        const auto lights = [kind = kind](std::size_t count) {
            return repeated(count, [&](std::size_t i) {
                return fmt::format("[entities.l{}.light]\ntype = \"{}\"\nintensity = 1\n", i, kind);
            });
        };
        expect_told(drawn(lights(most + 1)), 0, fmt::format("at most {} are drawn", most));
        expect_silent(drawn(lights(most)), "are drawn");
    }
}

TEST_F(CliLimits, DocumentsAndModels) {
    const auto shown = [&](const std::string& inside) {
        return Words{"develop",      path("frame.exr"),
                     "--ui",         write("a.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\">" + inside + "</svg>"),
                     "-q",           "-o",
                     path("out.png")};
    };
    expect_told(shown(repeated(20000, "<g/>")), 1, "a.svg:1: more than 20000 elements");
    expect_silent(shown(repeated(19999, "<g/>")), "elements");
    expect_told(shown(repeated(201, "<g>") + repeated(201, "</g>")), 1, "a.svg:1: elements in more than 200 others");
    expect_row("depth of the JSON | 64 |");
    const std::string model = write(
        "a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(64, '[') + std::string(64, ']') + "}");
    expect_told({"render", model, "-o", path("out.png")}, 1, "JSON nested deeper than 64 levels");
}

// Every row of every table is above, or held by a test that is named here.
TEST_F(CliLimits, EveryRowHasItsTest) {
    const std::map<std::string, Words> tests{
        {"Pictures and frames",
         {"CliBombs, Pictures", "ImageProportions, AChunkOfAnExrIsBounded", "ImageLightsHostile"}},
        {"Colour tables", {"CliLimits, LengthsOfFiles", "ImageTables, ATableNamesNoOtherFiles"}},
        {"Models",
         {"CliBombs, Models", "CliLimits, DocumentsAndModels",
          "ScenePackedDraco, CountsOutOfProportionAreToldBeforeTheyAreMade",
          "ScenePackedMeshoptModel, CountsOutOfProportionAreToldBeforeTheyAreMade"}},
        {"Interface documents", {"CliLimits, DocumentsAndModels", "CliLimits, LengthsOfFiles"}},
        {"Scenes", {"CliBombs, Scenes", "CliLimits, TextsOfScenes", "SceneError, PrefabsAreBounded"}},
        {"Effects of users", {"CliLimits, LengthsOfFiles", "CustomPasses"}},
        {"Play and edit",
         {"Document, HistoryIsBounded", "PanelTimingHistory, KeepsTheLastFramesInOrder",
          "SceneGround, AMeshBeyondTheBudgetIsItsBox"}},
        {"The device", {"RenderGpuRenderer, WhatShadersCannotReachIsToldBeforeItIsBound"}}};
    std::string sources;
    for (const char* const folder : {"src", "tests"})
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_folder) / folder))
            if (entry.path().string().ends_with("_test.cpp")) sources += test::content(entry.path());
    std::set<std::string> heads;
    std::istringstream lines(page_);
    std::string head;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) head = line.substr(3);
        if (line.starts_with("| ") && !line.starts_with("| What")) heads.insert(head);
    }
    for (const std::string& found : heads) {
        ASSERT_TRUE(tests.contains(found)) << found << " has limits and no test";
        for (const std::string& name : tests.at(found))
            EXPECT_NE(sources.find("(" + name), std::string::npos) << found << ": there is no test " << name;
    }
    EXPECT_EQ(heads.size(), tests.size());
    // The files that rows name are there: many were moved since.
    const std::regex file("`((?:src|include|apps)/[\\w/]+\\.[ch]pp)`");
    for (auto at = std::sregex_iterator(page_.begin(), page_.end(), file); at != std::sregex_iterator(); ++at)
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(test::source_folder) / (*at)[1].str())) << (*at)[1];
}

}  // namespace
}  // namespace darkroom
