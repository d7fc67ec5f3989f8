// SPDX-License-Identifier: MIT
// Files that are well-formed and cannot be meant: one line that says where, what, and what is allowed.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;
using Words = std::vector<std::string>;

class CliRefuse : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(8, 8);
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
    void expect_refused_by_both(const std::string& file, const std::string& part) const {
        expect_refused({"develop", path(file), "-o", path("out.png")}, 1, file + ": " + part);
        expect_refused({"probe", path(file), "--at", "1,1"}, 1, file + ": " + part);
    }
};

TEST_F(CliRefuse, CamerasOfFramesThroughWhichNothingIsSeen) {
    FrameFile frame;
    frame.color = Picture(8, 8);
    const Matrix rigid{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1};
    const auto write_with = [&](const FrameCamera& camera) {
        frame.camera = camera;
        ASSERT_TRUE(write_frame(path("a.exr"), frame));
    };
    const std::string inverse = ": allowed is a matrix with an inverse";
    write_with({.world_to_camera = Matrix{}, .projection = perspective(40, 1)});
    expect_refused_by_both("a.exr", "worldToCamera: all 16 numbers are 0" + inverse);
    const Outcome info = run({"info", path("a.exr"), "--json"});
    EXPECT_NE(info.out.find("cannot be developed: worldToCamera: all 16 numbers are 0"), std::string::npos) << info.out;
    write_with({.world_to_camera = rigid, .projection = Matrix{}});
    expect_refused_by_both("a.exr", "darkroom:projection: all 16 numbers are 0" + inverse);
    Matrix odd = rigid;
    odd[6] = std::numeric_limits<float>::quiet_NaN();
    write_with({.world_to_camera = odd, .projection = perspective(40, 1)});
    expect_refused_by_both("a.exr", "worldToCamera: number 7 of 16 is nan: allowed are finite numbers");
    odd[6] = std::numeric_limits<float>::infinity();
    write_with({.world_to_camera = rigid, .projection = perspective(40, 1), .previous_world_to_camera = odd});
    expect_refused_by_both("a.exr", "darkroom:previousWorldToCamera: number 7 of 16 is inf");
    write_with({.jitter = std::array{0.5F, 65.0F}});
    expect_refused_by_both("a.exr", "darkroom:jitter: number 2 of 2 is 65: allowed are [-64, 64] pixels");
    write_with({.previous_jitter = std::array{std::numeric_limits<float>::quiet_NaN(), 0.0F}});
    expect_refused_by_both("a.exr", "darkroom:previousJitter: number 1 of 2 is nan");
    Matrix flat = rigid;
    flat[10] = 0;
    write_with({.world_to_camera = flat});
    expect_refused_by_both("a.exr", "worldToCamera: the determinant is 0" + inverse);
    // Another one may stand in for it.
    write("c.toml", "fov = 40\ncamera_to_world = [1,0,0,4, 0,1,0,5, 0,0,1,6, 0,0,0,1]\n");
    EXPECT_EQ(run({"develop", path("a.exr"), "--camera", path("c.toml"), "-o", path("out.png")}).code, 0);
    // As small and as far as cameras are.
    Matrix far = rigid;
    far[12] = 1e8f;
    write_with({.world_to_camera = far, .projection = perspective(0.01, 1)});
    EXPECT_EQ(run({"develop", path("a.exr"), "-o", path("out.png")}).code, 0);
}

TEST_F(CliRefuse, CameraFilesThroughWhichNothingIsSeen) {
    const std::string zeros = "[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]\n";
    const auto expect = [&](const std::string& text, const std::string& part) {
        expect_refused({"develop", path("frame.exr"), "--camera", write("c.toml", text), "-o", path("out.png")}, 1,
                       "c.toml:1: " + part);
    };
    write("c.toml", "");
    expect("world_to_camera = " + zeros, "world_to_camera: all 16 numbers are 0: allowed is a matrix with an inverse");
    expect("camera_to_world = " + zeros, "camera_to_world: all 16 numbers are 0");
    for (const char* const last : {"0,0,0,0.5", "0,0,0.1,1"})
        expect(fmt::format("camera_to_world = [1,0,0,4, 0,1,0,5, 0,0,1,6, {}]\n", last),
               "camera_to_world: a rotation and a translation are needed");
    expect("projection = " + zeros, "projection: all 16 numbers are 0");
    expect("projection = [1,0,0,0, 0,nan,0,0, 0,0,1,0, 0,0,0,1]\n", "projection: number 6 of 16 is nan");
    expect("fov = nan\n", "fov: a number of degrees in (0, 180)");
}

TEST_F(CliRefuse, FilesThatAreNoScenes) {
    const std::string none = "is not a scene: it has no table [scene], [camera], [environment], [entities]";
    const auto expect = [&](const std::string& text, const std::string& part) {
        expect_refused({"render", write("a.toml", text), "--size", "8x8", "-o", path("out.png")}, 1, "a.toml: " + part);
    };
    write("a.toml", "");
    expect("", none);
    expect("# nothing\n", none);
    expect("x = 1\n", none);
    expect("[[stack]]\neffect = \"encode\"\n",
           none + ", [prefabs], nor any other table of a scene; a look is what --look takes");
    expect("[post_process]\nenabled = true\n", none);
    EXPECT_EQ(run({"render", write("a.toml", "[scene]\nname = \"bare\"\n"), "--size", "8x8", "-o", path("b.png")}).code,
              0);
}

// What can be told of a picture is told, whatever GPUs develop.
TEST_F(CliRefuse, PicturesThatAreWiderThanGpusDevelopAreDescribed) {
    ASSERT_TRUE(write_picture(path("wide.png"), Picture(20000, 2)));
    const Outcome info = run({"info", path("wide.png"), "--json"});
    EXPECT_EQ(info.code, 0) << info.err;
    const auto told = nlohmann::json::parse(info.out, nullptr, false);
    EXPECT_EQ(told["size"], nlohmann::json::parse("[20000,2]"));
    ASSERT_TRUE(told.contains("warnings")) << info.out;
    const std::string warning = told["warnings"].back();
    EXPECT_NE(warning.find("cannot be developed: "), std::string::npos) << warning;
    EXPECT_NE(warning.find("16384"), std::string::npos) << warning;
}

// Of what other libraries say, the reason is in our line, with the place and without their names, and they print none.
TEST_F(CliRefuse, WordsOfLibrariesAreInOneLineOfOurs) {
    ASSERT_TRUE(write_picture(path("whole.png"), Picture(200, 200)));
    const std::string whole = content(path("whole.png"));
    const auto expect = [&](const std::string& name, const std::string& line) {
        const Words typed = name.ends_with(".png") ? Words{"develop", path(name), "-o", path("out.exr")}
                                                   : Words{"lut", "convert", path(name), "-o", path("out.cube")};
        const Outcome outcome = run(typed);
        EXPECT_EQ(outcome.code, 1) << outcome.err;
        EXPECT_EQ(outcome.err, "darkroom: " + path(name) + ": " + line + "\n");
    };
    // The pixels of another picture, which are too few.
    Picture small(200, 100);
    ASSERT_TRUE(write_picture(path("small.png"), small));
    const std::string other = content(path("small.png"));
    const std::size_t header = 8 + 25;
    write("few.png", whole.substr(0, header) + other.substr(header));
    expect("few.png", "damaged or truncated: rows 1 to 128 of 200: Not enough image data");
    const std::string head = "<?xml version=\"1.0\"?>\n<ProcessList id=\"a\" compCLFversion=\"3.0\">\n";
    write("a.clf", head + "<Range/>\n</ProcessList>\n");
    expect("a.clf", "line 3: cannot be read as .clf: inBitDepth is missing");
    write("b.clf", head);
    expect("b.clf", "line 3: cannot be read as .clf: no element found");
    write("c.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n}\n");
    expect("c.spi1d", "line 7: cannot be read as .spi1d: Not enough entries found");
    write("d.spi3d", "SPILUT 1.0\n3 3\n2 2 2\n0 0 0 a\n");
    expect("d.spi3d", "cannot be read as .spi3d: Not enough entries found");
    write("e.csp", "LUT\n");
    expect("e.csp", "cannot be read as .csp: doesn't seem to be a csp LUT, expected 'CSPLUTV100'. First line: 'LUT'");
}

}  // namespace
}  // namespace darkroom
