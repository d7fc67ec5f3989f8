// SPDX-License-Identifier: MIT
// docs/limits.md, row by row: for a figure a file is made that is one beyond it, which has to be refused or told in one
// line, and where that is cheap one that is just within it. Rows that other tests hold are named with these.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <sstream>

#include "image/frame/frame_file.hpp"
#include "image/test_bytes.hpp"
#include "scene/gltf/test_model.hpp"
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
    refused({"develop", path("frame.exr"), "--ocio", sparse("a.ocio", "", 16 * mebibyte + 1), "--input-space", "x",
             "-o", out},
            16 * mebibyte);
    expect_row("file | 64 KiB, a regular one |");
    refused({"effects", sparse("a.glsl", "", 65537)}, 65536);
}

TEST_F(CliLimits, Pictures) {
    const auto described = [&](std::uint32_t width) {
        std::ofstream(path("a.png"), std::ios::binary) << png_start + png_header(width, 1, 8, 0) +
                                                              png_chunk("IDAT", stored(std::string(width + 1, '\0'))) +
                                                              png_chunk("IEND", "");
        return Words{"info", path("a.png")};
    };
    expect_told(described(65537), 1, "65537x1, [1, 65536] a side is allowed");
    expect_silent(described(65536), "allowed");
    const std::string wide = png_start + png_header(16385, 16384, 8, 0) +
                             png_chunk("IDAT", std::string(std::size_t{1} << 19, '\0')) + png_chunk("IEND", "");
    std::ofstream(path("wide.png"), std::ios::binary) << wide;
    expect_told({"develop", path("wide.png"), "-o", path("out.png")}, 1,
                "the picture is 16385x16384, at most 268435456 pixels are allowed");
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
    const std::string plain = write("a.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    expect_told({"develop", path("frame.exr"), "--ui", plain, "--size", "8193x2:stretch", "-q", "-o", path("out.png")},
                1, "8193x2");
    expect_row("depth of the JSON | 64 |");
    const std::string model = write(
        "a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(64, '[') + std::string(64, ']') + "}");
    const auto rendered = [&](const std::string& file) {
        return Words{"render", file, "--size", "8x8", "-q", "-o", path("out.png")};
    };
    expect_told(rendered(model), 1, "JSON nested deeper than 64 levels");
    const auto with_triangle = [&](const auto& change) {
        scene::TestModel test;
        auto& primitive = test.add_triangle();
        test.json["accessors"][0]["min"] = {0, 0, 0};
        test.json["accessors"][0]["max"] = {1, 1, 0};
        change(test, primitive);
        return rendered(write("a.gltf", test.text()));
    };
    const auto nowhere = [&](std::uint64_t bytes) {
        return with_triangle([&](scene::TestModel& test, auto& primitive) {
            static_cast<void>(test.text());
            test.json["buffers"].push_back({{"byteLength", bytes}});
            test.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
            test.json["accessors"].push_back({{"bufferView", test.json["bufferViews"].size() - 1},
                                              {"componentType", 5126},
                                              {"count", 3},
                                              {"type", "VEC3"}});
            primitive["attributes"]["NORMAL"] = test.json["accessors"].size() - 1;
        });
    };
    expect_told(nowhere(mebibyte + 1), 1, "a.gltf: /buffers/1: has neither a URI nor a BIN chunk");
    expect_told(nowhere(mebibyte), 0, "/buffers/1: has neither a URI nor a BIN chunk");
    const auto textured = [&](std::uint32_t side) {
        return with_triangle([&](scene::TestModel& test, auto& primitive) {
            primitive["material"] = 0;
            test.json["images"] = {{{"uri", "data:image/png;base64," +
                                                scene::base64(png_start + png_header(side, 1, 8, 0) +
                                                              png_chunk("IDAT", stored(std::string(side + 1, '\0'))) +
                                                              png_chunk("IEND", ""))}}};
            test.json["textures"] = {{{"source", 0}}};
            test.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        });
    };
    expect_told(textured(16385), 0, "16385x1, [1, 16384] a side is allowed");
    expect_silent(textured(16384), "allowed");
    expect_told(
        with_triangle([](scene::TestModel& test, auto& primitive) {
            primitive["attributes"]["JOINTS_0"] =
                test.accessor<std::uint32_t>({65536, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
            primitive["attributes"]["WEIGHTS_0"] = test.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
            test.json["skins"] = {{{"joints", {0}}}};
            test.json["nodes"][0]["skin"] = 0;
        }),
        1, "JOINTS_0");
}

/// A row as it begins, figures included, and the tests with a file beyond it.
struct HeldRow {
    std::string start;
    Words tests;
};

const std::vector<HeldRow>& held_rows() {
    static const std::vector<HeldRow> rows{
        {"side of a picture | 65536 pixels",
         {"CliLimits, Pictures", "ImageProportions, SidesPartsAndChannelsOfAnExrAreBounded",
          "HostilePictures, TiffAsksForNoMoreThanIsAllowed"}},
        {"an image file | 4 GiB", {"CliLimits, LengthsOfFiles"}},
        {"decoded pixels of any kind of file, all parts of an OpenEXR file together | 1 GiB, or 128 bytes",
         {"CliBombs, Pictures", "ImageProportions, AnExrOfZerosIsRefusedForWhatItAsksFor"}},
        {"chunk of OpenEXR: a tile, or the lines packed together | 256 MiB (a tile of 4096x4096",
         {"ImageProportions, AChunkOfAnExrIsBounded"}},
        {"pixels for a byte of OpenEXR | by compression, from 1 (none) to 70000",
         {"ImageProportions, AnExrOfZerosIsRefusedForWhatItAsksFor"}},
        {"tile of TIFF | 8192 pixels a side; of the bytes of the picture, 16 MiB always, 256 MiB at most",
         {"HostilePictures, TiffAsksForNoMoreThanIsAllowed"}},
        {"bytes of all strips or tiles of TIFF, which may share them | 4 times the file",
         {"HostilePictures, TiffAsksForNoMoreThanIsAllowed"}},
        {"scans of JPEG, alone or in TIFF | 100; scans times pixels 2^31", {"HostilePictures, ScansOfJpegAreCounted"}},
        {"profile of colours in PNG | 4 MiB", {"HostilePictures, AProfileOfPngIsInflatedHere"}},
        {"bytes that the pixels of PNG are packed in | twice what they take unpacked, and 64 KiB",
         {"HostilePictures, PixelsOfPngArePackedInNoMoreThanTheyNeed"}},
        {"pixels of a frame | 2^28", {"CliLimits, Pictures"}},
        {"side of a picture in WebP, all in one chunk | 16384",
         {"ImageWebp, PixelsAreThoseThatWerePacked", "ImageWebp, WhatItsChunksDoNotHoldIsRefused"}},
        {"display window of OpenEXR | 64 times the largest data window; up to 2^25 pixels always",
         {"ImageProportions, SidesPartsAndChannelsOfAnExrAreBounded"}},
        {"parts, channels of a part, side of a tile | 256, 1024, 8192",
         {"ImageProportions, SidesPartsAndChannelsOfAnExrAreBounded"}},
        {"attributes of OpenEXR, of all parts, strings of lists counted | 65536, 32 MiB",
         {"ImageProportions, AttributesOfAnExrAreCounted"}},
        {"point and spot lights of a scene that cast shadows at a time | 8, of at most 48 tiles of 1024",
         {"RenderLampShadows, TilesAreOneASpotAndSixAPoint",
          "RenderLampShadows, TheBudgetGoesToThoseWithTheMostLightAtTheCamera"}},
        {"lights and shadow maps of a frame | 16 and 4, of at most 4 cascades, 16384 texels a side and 2^30",
         {"ImageLights, WhatCouldNotBeReadIsNotWritten", "ImageLightsHostile, WrongNumbersAreRefused"}},
        {"time | 60 s, and 1 s for each 4 MiB decoded", {"ImageConfined, ADecoderThatHangsIsGivenUp"}},
        {"memory, in address space; none under sanitizers | 4 GiB, 2 times the file, and 4 times",
         {"ImageConfined, ADecoderThatTakesTooMuchMemoryIsAnError"}},
        {"processes | one for each processor, and as many with OpenImageIO",
         {"ImageConfined, ThereAreAsManyProcessesAsProcessors"}},
        {"a configuration of OpenColorIO; the tables that it names are its own, and it is trusted with them | 16 MiB",
         {"CliLimits, LengthsOfFiles"}},
        {"`.cube`; other tables, with all that they name, one that is named twice counted twice | 1 GiB; 32 MiB, 64",
         {"CliLimits, LengthsOfFiles"}},
        {"value of the JSON (in the tree, in text, in the library) | 256",
         {"SceneGltfRefuse, CountsOutOfProportionAreToldBeforeTheyAreMade"}},
        {"element of an array of the root: node, accessor, texture, ... | 1024; material: 3072",
         {"SceneGltfRefuse, CountsOutOfProportionAreToldBeforeTheyAreMade"}},
        {"vertex, skinned vertex while it is read, vertex of a morph target | 60, 88, 24",
         {"SceneGltfRefuse, WhatIsMadeOfAPrimitiveIsToldWithItsBytes"}},
        {"corner of a triangle | 4, and 12 while it is read",
         {"SceneGltfRefuse, WhatIsMadeOfAPrimitiveIsToldWithItsBytes"}},
        {"number of an accessor, each time it is read | 4",
         {"SceneGltfRefuse, CountsOutOfProportionAreToldBeforeTheyAreMade"}},
        {"bytes of all files of a model | 4 GiB", {"CliLimits, LengthsOfFiles"}},
        {"buffer that is nowhere (all are zeros, which they share) | 1 MiB", {"CliLimits, DocumentsAndModels"}},
        {"depth of the JSON | 64", {"CliLimits, DocumentsAndModels"}},
        {"side of a texture | 16384 pixels", {"CliLimits, DocumentsAndModels"}},
        {"joint that a vertex names | 65535", {"CliLimits, DocumentsAndModels"}},
        {"an SVG document, its values in place | 1 MiB, 20000 elements, 200 in one another",
         {"CliLimits, LengthsOfFiles", "CliLimits, DocumentsAndModels"}},
        {"instance: a primitive of a node, or a box (with its material) | 1024 (1536)",
         {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"material of a model | 512", {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"node, once for each animation and speed; again as work for each entity | 256",
         {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"joint of a skin, for each node that has it | 384", {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"weight of a morph target, for each node | 32", {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"light, sprite | 256", {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"particle | 256", {"SceneSnapshotBudget, BytesAreThoseOfThePage"}},
        {"work: vertex of a skin or with morph targets (times their number and one), for each node | 32",
         {"SceneSnapshotBudget, WorkIsThatOfThePage"}},
        {"work: triangle | 4", {"SceneSnapshotBudget, WorkIsThatOfThePage"}},
        {"work: parent, for each material and particle below it | 8", {"SceneSnapshotBudget, WorkIsThatOfThePage"}},
        {"work: emitter | 512 KiB", {"SceneSnapshotBudget, WorkIsThatOfThePage"}},
        {"its picture | 8192 pixels a side", {"CliLimits, DocumentsAndModels"}},
        {"a drawing | 5 s, 4 GiB", {"HudDocuments, WhatTakesTooLongIsGivenUp"}},
        {"scene, prefab, look or camera file | 4 MiB", {"CliLimits, LengthsOfFiles"}},
        {"nesting of values; dots of one line; dots of all keys | 16; 64; 262144",
         {"CliLimits, TextsOfScenes", "CliBombs, Scenes"}},
        {"entities, prefabs, prefabs in each other | 100000, 10000, 16", {"CliLimits, TextsOfScenes"}},
        {"values, with those that prefabs multiply | 1000000", {"SceneError, PrefabsAreBounded"}},
        {"particles of an emitter | 10000", {"CliLimits, TextsOfScenes"}},
        {"lights that are drawn: directional, point, spot | 4, 16, 8", {"CliLimits, TextsOfScenes"}},
        {"file | 64 KiB, a regular one", {"CliLimits, LengthsOfFiles", "CustomPasses, CountsHaveBounds"}},
        {"parameters, images, passes, images that a function reads | 64, 16, 32, 8",
         {"CustomPasses, CountsHaveBounds"}},
        {"images, buffers and values that a pass writes, buffers and values that a function names;",
         {"CustomCompute, ErrorsNameTheLineTheThingAndWhatIsAllowed"}},
        {"invocations of a workgroup, and groups where their number is given; bytes of `shared` variables;",
         {"CustomCompute, ErrorsNameTheLineTheThingAndWhatIsAllowed"}},
        {"size of an image, of the picture's | 1/64 to 2", {"CustomPasses, ErrorsNameTheLineTheThingAndWhatIsAllowed"}},
        {"texels of a table | 4096", {"CustomPasses, TablesAreReadAndCounted"}},
        {"frames before the first that a history asks for | 1000",
         {"CustomPasses, ErrorsNameTheLineTheThingAndWhatIsAllowed"}},
        {"words and marks of a statement; characters of the value of a `#define` | 2000; 120",
         {"CustomPasses, CodeDeclaresNothingOfTheKernel"}},
        {"words and marks of a function, those of all that it calls included;",
         {"CustomPasses, CodeDeclaresNothingOfTheKernel"}},
        {"gain map of JPEG |", {"CliGainMap, WhatIsNotAppliedIsTold", "CliGainMap, ADamagedOneIsRefused"}},
        {"file of kernels; kernels in it | 16 MiB; 65536", {"BakedShaders, EveryNumberIsCheckedBeforeItIsUsed"}},
        {"entries of a look's stack | 4096", {"LookSlips, WhatAFileHoldsManyOfIsBounded"}},
        {"entries in a fused kernel; entries of a plan that join a kernel begun by another | 16; 96;",
         {"ComposePlan, ALongStackHasKernelsAndPicturesWithinBounds"}},
        {"kernels of a plan that do not run while their entries are off, as each keeps a picture | 32;",
         {"ComposePlan, ALongStackHasKernelsAndPicturesWithinBounds"}},
        {"picture that `scale` of an entry makes | the same;",
         {"ComposeExtent, AScaleThatNoDeviceHoldsIsRefusedBeforeItIsTried"}},
        {"undo | 1000 steps, 256 MiB of them", {"Document, HistoryIsBounded", "Document, HistoryOfTablesIsBounded"}},
        {"ground to walk on | 2^20 triangles, 2^22 entries", {"SceneGround, AMeshBeyondTheBudgetIsItsBox"}},
        {"times | 240 frames of 256 passes", {"PanelTimingHistory, KeepsTheLastFramesInOrder"}}};
    return rows;
}

/// Those that no file of a test goes beyond: counts of bytes that suites of hostile files hold as a whole (CliBombs,
/// ScenePackedDraco), numbers that would take gigabytes, and what no file asks for.
constexpr std::array rows_held_together{"numbers of the layers that `--keep-layers` keeps |",
                                        "joint of a skin | 128 |",
                                        "triangle that Draco unpacks,",
                                        "byte that meshoptimizer unpacks |",
                                        "number of an attribute that Draco unpacks,",
                                        "pixels of a model's textures together |",
                                        "keys of all paths |",
                                        "entries of a folder in the file browser |",
                                        "messages, lines that the console keeps,",
                                        "frames of a sequence that are held decoded |",
                                        "size of a picture | `max",
                                        "texture beyond it |",
                                        "textures that a surface's shader reads",
                                        "storage buffer of a scene"};

TEST_F(CliLimits, EveryRowHasItsTest) {
    std::string sources;
    for (const char* const folder : {"engine", "files", "run", "scenes", "edit", "proof", "tests"})
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_folder) / folder))
            if (entry.path().string().ends_with("_test.cpp")) sources += test::content(entry.path());
    for (const HeldRow& row : held_rows()) {
        expect_row(row.start);
        for (const std::string& name : row.tests)
            EXPECT_NE(sources.find("(" + name + ")"), std::string::npos) << row.start << ": there is no test " << name;
    }
    std::istringstream lines(page_);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("| ") || line.starts_with("| What")) continue;
        const std::string row = line.substr(2);
        const bool is_held =
            std::ranges::any_of(held_rows(), [&](const HeldRow& held) { return row.starts_with(held.start); }) ||
            std::ranges::any_of(rows_held_together, [&](const char* start) { return row.starts_with(start); });
        EXPECT_TRUE(is_held) << "docs/limits.md: no test is known for: " << row;
    }
    // The files that rows name are there: many were moved since.
    const std::regex file("`((?:include|engine|files|run|scenes|edit|proof|programs)/[\\w/]+\\.[ch]pp)`");
    for (auto at = std::sregex_iterator(page_.begin(), page_.end(), file); at != std::sregex_iterator(); ++at)
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(test::source_folder) / (*at)[1].str())) << (*at)[1];
}

}  // namespace
}  // namespace darkroom
