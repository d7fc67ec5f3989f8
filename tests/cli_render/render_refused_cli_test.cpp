// SPDX-License-Identifier: MIT
// What `darkroom render` refuses, and that nothing is lost by it.
#include <fmt/format.h>

#include "tests/cli_render/render_cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliRenderRefused : public test::CliRender {};

TEST_F(CliRenderRefused, WrongScenesAreRefused) {
    const std::string out = path("x.png");
    expect_refused({"render"}, 1, "SCENE");
    expect_refused({"render", path("none.scene.toml"), "-o", out}, 1, "none.scene.toml");
    expect_refused({"render", write("bad.scene.toml", "[scene\n"), "-o", out}, 1, "bad.scene.toml:1:");
    expect_refused({"render", write("bad.glb", "glTF"), "-o", out}, 1, "bad.glb");
    expect_refused({"render", path("none.gltf"), "-o", out}, 1, "none.gltf");
    write("slip.scene.toml", std::string(test::yard_scene) + "[entities.a.transform]\npositoin = [0, 0, 0]\n");
    const Outcome lenient = run({"render", path("slip.scene.toml"), "-o", path("ok.png"), "--size", "8x8"});
    EXPECT_EQ(lenient.code, 0) << lenient.err;
    EXPECT_NE(lenient.err.find("positoin"), std::string::npos) << lenient.err;
    expect_refused({"render", path("slip.scene.toml"), "-o", out, "--strict"}, 1, "positoin");
}

TEST_F(CliRenderRefused, WrongSizesAndFilesAreRefused) {
    for (const char* const size : {"0x0", "5x", "4294967297x1"}) expect_render_refused({"--size", size}, "--size");
    expect_render_refused({"--size", "4x4", "--width", "5"}, "--size 4x4");
    expect_render_refused({"--size", "99999x2"}, "allows 1x1 to");
    expect_render_refused({"--bits", "12"}, "--bits 12");
    expect_render_refused({"--frame", path("f.png")}, "--save-frame");
    expect_render_refused({"--frame", path("none/f.exr")}, "none");
    expect_refused({"render", path("yard.scene.toml"), "-o", path("x.xyz")}, 1, ".xyz");
    expect_refused({"render", path("yard.scene.toml"), "-o", path("none/x.png")}, 1, "none");
    expect_refused({"render", path("yard.scene.toml"), "-o", path("x.exr"), "--frame", path("x.exr")}, 1,
                   "-o and --save-frame name the same file");
}

TEST_F(CliRenderRefused, WhatTheSceneReadsIsNotOverwritten) {
    Picture texture(2, 2);
    ASSERT_TRUE(write_picture(path("leaf.png"), texture));
    const std::string before = content(path("leaf.png"));
    const std::string scene =
        write("leaf.scene.toml", std::string(test::yard_scene) + "[entities.leaf.sprite]\ntexture = \"leaf.png\"\n");
    expect_refused({"render", scene, "--size", "8x8", "-o", path("leaf.png")}, 1, "leaf.png");
    EXPECT_EQ(content(path("leaf.png")), before);
}

TEST_F(CliRenderRefused, DevicesAndEmptyValuesAreRefused) {
    const std::string scene =
        write("sky.scene.toml", std::string(test::yard_scene) + "[environment]\nskybox = \"/dev/zero\"\n");
    const Outcome outcome = run({"render", scene, "--size", "8x8", "-o", path("sky.png")});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("/dev/zero: is a device, a regular file is needed (asked for by the environment)"),
              std::string::npos)
        << outcome.err;
    expect_refused({"render", path("yard.scene.toml"), "--size=", "-o", path("x.png")}, 1,
                   "--size: one value is needed");
    expect_refused({"develop", "/dev/zero", "-o", path("x.png")}, 1,
                   "/dev/zero: is a device, a regular file is needed");
}

TEST_F(CliRenderRefused, WrongValuesAreRefused) {
    for (const char* const target : {"1,2", "1,2,3,4", "a,b,c", "", "1,2,1e300"})
        expect_render_refused({std::string("--target=") + target}, "--target");
    expect_render_refused({"--debug-mode", "wirefrane"},
                          "did you mean 'wireframe'? allowed is wireframe, normals, depth, uv, unlit or metalrough");
    expect_render_refused({"--no-such-flag"}, "--no-such-flag");
    expect_render_refused({"--device", "none such"}, "none such");
    expect_render_refused({"--kernels", "magic"}, "auto, compute or raster");
    expect_render_refused({"--order", "sideways"}, "documented or scene_linear");
    expect_render_refused({"--look", path("none.toml")}, "none.toml");
    expect_render_refused({"--no-postprocess", "--timings"}, "--timings");
}

TEST_F(CliRenderRefused, CountsOfSamplesThatTheDeviceLacksAreRefusedByName) {
    expect_render_refused({"--msaa", "3"}, "1, ");
    expect_render_refused({"--msaa", "64"}, "1, ");
}

TEST_F(CliRenderRefused, WrongMomentsAreRefused) {
    for (const char* const frames : {"5-3", "1-", "1-2-3", "", "0-999999999999"})
        expect_render_refused({std::string("--frames=") + frames}, "--frames");
    expect_render_refused({"--frames", "1-3"}, "%04d");
    expect_refused(
        {"render", path("yard.scene.toml"), "-o", path("p.%04d.png"), "--frames", "1-3", "--frame", path("f.exr")}, 1,
        "--save-frame");
    expect_render_refused({"--time", "1", "--frames", "2"}, "--time");
}

TEST_F(CliRenderRefused, AnExistingPictureSurvivesAFailure) {
    const std::string kept = write("kept.png", "kept");
    EXPECT_EQ(run({"render", write("bad.scene.toml", "= 1"), "-o", kept}).code, 1);
    EXPECT_EQ(content(kept), "kept");
}

}  // namespace
}  // namespace darkroom
