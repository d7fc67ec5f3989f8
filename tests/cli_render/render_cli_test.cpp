// SPDX-License-Identifier: MIT
// `darkroom render` as its users meet it: what each flag does, and which files there are afterwards.
#include <darkroom/effects.hpp>

#include <map>
#include <set>

#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "tests/cli_render/render_cli_support.hpp"

namespace darkroom {
namespace {

using test::CliRender;
using test::content;
using test::Outcome;

/// What a flag does. A suite of its own, as what is refused is, since each of their runs is a process.
class CliRenderFlags : public CliRender {};

TEST_F(CliRender, RendersAScene) {
    const Outcome outcome = render({});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.told,
              "Loaded scene Yard\nEntities: 5\n" + path("yard.scene.toml") + " -> " + path("out.png") + " (48x32)\n");
    EXPECT_EQ(files(), (std::vector<std::string>{"out.png", "yard.scene.toml"})) << "nothing else is left behind";
    ASSERT_EQ(render({}, "again.png").code, 0);
    EXPECT_EQ(content(path("out.png")), content(path("again.png")));
    std::set<float> values;
    for (const float value : picture("out.png").pixels) values.insert(value);
    EXPECT_GT(values.size(), 20u) << "there is something to see";
}

TEST_F(CliRender, AnySizeIsASize) {
    for (const auto& [flags, width, height] :
         std::vector<std::tuple<std::vector<std::string>, std::uint32_t, std::uint32_t>>{
             {{"--size", "1x1"}, 1, 1},
             {{"--size", "7x3"}, 7, 3},
             {{"--width", "5", "--height", "90"}, 5, 90},
             {{"--size", "8192x2"}, 8192, 2}}) {
        const Outcome outcome = render(flags);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(picture("out.png").width, width);
        EXPECT_EQ(picture("out.png").height, height);
    }
}

TEST_F(CliRender, FiveThousandPixelsAcrossShowTheSameAsFewer) {
    ASSERT_EQ(render({"--size", "5120x2880", "--samples", "1", "--no-grid"}, "large.png").code, 0);
    ASSERT_EQ(render({"--size", "320x180", "--samples", "64", "--no-grid"}, "small.png").code, 0);
    const Picture large = picture("large.png"), small = picture("small.png");
    ASSERT_EQ(large.width, 5120U);
    ASSERT_EQ(large.height, 2880U);
    double apart = 0;
    for (std::uint32_t y = 0; y < small.height; ++y) {
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const float *const a = large.at(x * 16 + 8, y * 16 + 8), *const b = small.at(x, y);
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(a[c] >= 0 && a[c] <= 1);
                apart += std::abs(a[c] - b[c]);
            }
        }
    }
    EXPECT_LT(apart / (small.width * small.height * 3), 0.01);
}

TEST_F(CliRender, WritesEveryKindOfFile) {
    for (const auto& [name, flags] :
         std::vector<std::pair<std::string, std::vector<std::string>>>{{"a.jpg", {}},
                                                                       {"a.tif", {"--bits", "16"}},
                                                                       {"b.tif", {"--bits", "16", "--no-postprocess"}},
                                                                       {"a.exr", {"--debug-mode", "normals"}},
                                                                       {"a.hdr", {}}}) {
        const Outcome outcome = render(flags, name);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "") << name;
        EXPECT_EQ(picture(name).height, 32u);
    }
}

TEST_F(CliRenderFlags, EveryDebugModeIsAPicture) {
    expect_all_differ({{},
                       {"--debug-mode", "wireframe"},
                       {"--debug-mode", "normals"},
                       {"--debug-mode", "depth"},
                       {"--debug-mode", "uv"},
                       {"--debug-mode", "unlit"},
                       {"--debug-mode", "metalrough"}});
}

TEST_F(CliRenderFlags, EveryMomentIsAPicture) {
    expect_all_differ({{}, {"--time", "1"}, {"--time", "2.5"}, {"--time", "1", "--seed", "9"}});
}

TEST_F(CliRenderFlags, DefaultsAreThoseOfTheHelp) {
    ASSERT_EQ(render({}, "a.png").code, 0);
    ASSERT_EQ(render({"--shadow-resolution", "2048", "--shadow-filter", "soft", "--msaa", "1", "--fps", "24", "--time",
                      "0", "--seed", "0"},
                     "b.png")
                  .code,
              0);
    EXPECT_EQ(content(path("a.png")), content(path("b.png")));
    const std::string help = run({"render", "--help-all"}).out;
    for (const char* const flag : {"--output",
                                   "--width",
                                   "--height",
                                   "--size",
                                   "--distance",
                                   "--yaw",
                                   "--pitch",
                                   "--target",
                                   "--fov",
                                   "--no-grid",
                                   "--debug-mode",
                                   "--wireframe-overlay",
                                   "--show-normals",
                                   "--no-tonemapping",
                                   "--no-shadows",
                                   "--shadow-resolution",
                                   "--no-postprocess",
                                   "--msaa",
                                   "--time",
                                   "--frames",
                                   "--fps",
                                   "--seed",
                                   "--frame",
                                   "--bits",
                                   "--alpha",
                                   "--timings",
                                   "--device",
                                   "--kernels",
                                   "--look"})
        EXPECT_NE(help.find(flag), std::string::npos) << flag;
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows)
            EXPECT_NE(help.find(flag_name(flat_key(effect->name, row.name)) + " "), std::string::npos) << effect->name;
}

TEST_F(CliRenderFlags, FlagsWinOverTheSceneWhichWinsOverDefaults) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect exposure is not in this build";
    const std::string plain =
        write("plain.scene.toml",
              std::string(test::yard_scene).replace(std::string(test::yard_scene).find("exposure = 0.6"), 14, ""));
    const auto other = [&](std::vector<std::string> flags, const std::string& out) {
        flags.insert(flags.begin(), {"render", plain, "-o", path(out), "--size", "48x32"});
        return run(flags).code;
    };
    ASSERT_EQ(other({}, "default.png"), 0);
    ASSERT_EQ(other({"--exposure", "0.6"}, "flag.png"), 0);
    ASSERT_EQ(render({}, "scene.png").code, 0);
    ASSERT_EQ(render({"--exposure", "1"}, "both.png").code, 0);
    EXPECT_NE(content(path("default.png")), content(path("scene.png")));
    EXPECT_EQ(content(path("flag.png")), content(path("scene.png")));
    EXPECT_EQ(content(path("both.png")), content(path("default.png")));
    const std::string look = write("look.toml", "[post_process]\nexposure = 1.0\n");
    ASSERT_EQ(render({"--look", look}, "look.png").code, 0);
    EXPECT_EQ(content(path("look.png")), content(path("default.png"))) << "a look takes the place of the scene's";
}

TEST_F(CliRender, DevelopingTheFrameGivesThePicture) {
    const std::vector<std::vector<std::string>> cases{
        {}, {"--frames", "36", "--dither-enabled", "on"}, {"--msaa", "4", "--kernels", "compute", "--exposure", "3"}};
    for (std::vector<std::string> flags : cases) {
        if (find_effect("dither") == nullptr && flags.size() == 4) continue;
        if (find_effect("exposure") == nullptr && flags.size() == 6) continue;
        flags.insert(flags.end(), {"--frame", path("f.exr")});
        const Outcome rendered = render(flags, "a.png");
        ASSERT_EQ(rendered.code, 0) << rendered.err;
        std::vector<std::string> again{"develop", path("f.exr"), "--look", path("yard.scene.toml"),
                                       "-o",      path("b.png")};
        for (std::size_t i = 0; i + 1 < flags.size(); i += 2)
            if (flags[i] != "--msaa" && flags[i] != "--frames" && flags[i] != "--frame")
                again.insert(again.end(), {flags[i], flags[i + 1]});
        const Outcome developed = run(again);
        ASSERT_EQ(developed.code, 0) << developed.err;
        EXPECT_EQ(developed.err, "");
        EXPECT_EQ(content(path("a.png")), content(path("b.png")));
    }
}

TEST_F(CliRender, AFrameHasEveryLayer) {
    ASSERT_EQ(render({"--time", "2", "--fps", "10", "--frame", path("f.exr")}).code, 0);
    const FrameFile file = frame("f.exr");
    ASSERT_TRUE(file.depth && file.normals && file.velocity);
    ASSERT_TRUE(file.camera.world_to_camera && file.camera.projection && file.camera.previous_world_to_camera);
    EXPECT_EQ(file.samples, SampleKind::Half);
    EXPECT_EQ(file.camera.near_distance, 0.1F);
    EXPECT_EQ(file.time, 2);
    EXPECT_EQ(file.delta_time, 0.1);
    EXPECT_EQ(file.frame_index, 0u);
    EXPECT_EQ(std::count(file.depth->values.begin(), file.depth->values.end(), sky_depth) > 0, true);
    float fastest = 0;
    for (const float speed : file.velocity->values) fastest = std::max(fastest, std::abs(speed));
    EXPECT_GT(fastest, 0.1F) << "the box moves 5 cm a frame";
    ASSERT_EQ(render({"--time", "2", "--fps", "20", "--frame", path("g.exr")}).code, 0);
    float slower = 0;
    const FrameFile other = frame("g.exr");
    ASSERT_TRUE(other.velocity);
    for (const float speed : other.velocity->values) slower = std::max(slower, std::abs(speed));
    EXPECT_NEAR(slower / fastest, 0.5F, 0.1F);
}

TEST_F(CliRender, FloatFilesHoldNoTimeOfDay) {
    ASSERT_EQ(render({"--frame", path("frame.exr")}, "picture.exr").code, 0);
    for (const char* const name : {"frame.exr", "picture.exr"})
        for (const char* const date : {"DateTime", "capDate"})
            EXPECT_EQ(content(path(name)).find(date), std::string::npos) << name;
}

TEST_F(CliRender, FramesAreNumbered) {
    const Outcome outcome = render({"--frames", "3-5", "--fps", "2", "--frame", path("f.%03d.exr")}, "p.%04d.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(files(), (std::vector<std::string>{"f.003.exr", "f.004.exr", "f.005.exr", "p.0003.png", "p.0004.png",
                                                 "p.0005.png", "yard.scene.toml"}));
    EXPECT_NE(content(path("p.0003.png")), content(path("p.0004.png")));
    EXPECT_NE(outcome.told.find("-> " + path("p.0004.png") + " (48x32)"), std::string::npos) << outcome.told;
    const FrameFile four = frame("f.004.exr");
    EXPECT_EQ(four.time, 2);
    EXPECT_EQ(four.frame_index, 4u);
    // A frame is what it is, whichever were rendered before it.
    ASSERT_EQ(render({"--time", "2", "--fps", "2", "--frame", path("alone.exr")}).code, 0);
    const FrameFile alone = frame("alone.exr");
    EXPECT_EQ(four.color, alone.color);
    EXPECT_EQ(four.velocity, alone.velocity);
    EXPECT_EQ(four.camera.previous_world_to_camera, alone.camera.previous_world_to_camera);
}

TEST_F(CliRender, FloatFilesWithoutPostProcessingAreTheLightItself) {
    ASSERT_EQ(render({"--no-postprocess", "--bits", "half", "--frame", path("f.exr")}, "light.exr").code, 0);
    const FrameFile file = frame("f.exr"), light = frame("light.exr");
    ASSERT_EQ(light.color.pixels.size(), file.color.pixels.size());
    float brightest = 0;
    for (std::size_t i = 0; i < light.color.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        ASSERT_EQ(light.color.pixels[i], file.color.pixels[i]);
        brightest = std::max(brightest, light.color.pixels[i]);
    }
    EXPECT_GT(brightest, 2) << "the lamp is not cut off";
}

TEST_F(CliRender, PostProcessingOffIsTheShadersOwnCurve) {
    // The grid is blended, and so are samples: blending in two spaces differs.
    std::vector<std::string> hard{"--no-grid", "--msaa", "1", "--samples", "1"};
    if (find_effect("exposure") != nullptr) hard.insert(hard.end(), {"--exposure", "2.5"});
    std::vector<std::string> all_off = hard, off_at_once = hard;
    off_at_once.emplace_back("--no-postprocess");
    ASSERT_EQ(render(off_at_once, "off.png").code, 0);
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0 && effect->makes == nullptr && effect->name != "exposure")
            all_off.insert(all_off.end(), {flag_name(flat_key(effect->name, "enabled")), "off"});
    ASSERT_EQ(render(all_off, "all_off.png").code, 0);
    const Result<Comparison> result = compare(picture("off.png"), picture("all_off.png"));
    ASSERT_TRUE(result);
    EXPECT_LE(result->max_error, 2.001 / 255);
    const std::string off = write(
        "off.scene.toml", std::string(test::yard_scene)
                              .replace(std::string(test::yard_scene).find("exposure = 0.6"), 14, "enabled = false"));
    std::vector<std::string> by_scene{"render", off, "-o", path("by_scene.png"), "--size", "48x32"};
    by_scene.insert(by_scene.end(), hard.begin(), hard.end());
    ASSERT_EQ(run(by_scene).code, 0);
    EXPECT_EQ(content(path("by_scene.png")), content(path("off.png")));
}

TEST_F(CliRender, VolumetricLightNeedsShadows) {
    if (find_effect("volumetric") == nullptr) GTEST_SKIP() << "the effect volumetric is not in this build";
    ASSERT_EQ(render({"--no-shadows"}, "plain.png").code, 0);
    const Outcome outcome = render({"--no-shadows", "--volumetric-density", "20"}, "haze.png");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("left out: volumetric: needs shadows"), std::string::npos) << outcome.err;
    EXPECT_EQ(content(path("plain.png")), content(path("haze.png")));
    expect_all_differ({{}, {"--volumetric-density", "20"}});
}

// depth_of_field.md: a thin lens, which rays side by side do not have.
TEST_F(CliRender, ALensNeedsPerspective) {
    if (find_effect("depth_of_field") == nullptr) GTEST_SKIP() << "the effect depth_of_field is not in this build";
    const std::string said =
        "warning: left out: depth_of_field: needs perspective, which the frame's camera does not have";
    const std::vector<std::string> lens{"--depth-of-field-focus-distance", "3", "--depth-of-field-f-stop", "0.5",
                                        "--depth-of-field-enabled",        "on"};
    Outcome outcome = render(lens);
    EXPECT_EQ(outcome.err, "");
    std::string scene(test::yard_scene);
    write("parallel.scene.toml", scene.replace(scene.find("fov = 50"), 8, "projection = \"orthographic\""));
    const auto parallel = [&](std::vector<std::string> flags, const std::string& out) {
        flags.insert(flags.begin(),
                     {"render", path("parallel.scene.toml"), "-o", path(out), "--size", "48x32", "--samples", "1"});
        return run(flags);
    };
    EXPECT_EQ(parallel({"--frame", path("f.exr"), "--shadow-resolution", "256"}, "plain.png").err, "");
    outcome = parallel(lens, "lens.png");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    const Picture plain = picture("plain.png"), seen = picture("lens.png");
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) ASSERT_NEAR(plain.pixels[i], seen.pixels[i], 1.5 / 255) << i;
    for (const bool is_reference : {false, true}) {
        std::vector<std::string> develop{"develop", path("f.exr"), "-o", path("d.png")};
        develop.insert(develop.end(), lens.begin(), lens.end());
        if (is_reference) develop.emplace_back("--reference");
        outcome = run(develop);
        EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    }
}

TEST_F(CliRenderFlags, AmountsSwitchTheirEffectOn) {
    using Flags = std::vector<std::string>;
    const auto picture_of = [&](Flags flags, const Flags& more = {}) {
        flags.insert(flags.end(), more.begin(), more.end());
        const Outcome outcome = render(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return content(path("out.png"));
    };
    const std::string plain = picture_of({});
    for (const auto& [amount, on, off] : std::vector<std::tuple<Flags, Flags, Flags>>{
             {{"--fog-density", "0.3"}, {"--fog-enabled", "on"}, {"--fog-enabled", "off"}},
             {{"--fog-height-falloff", "0.2"},
              {"--fog-enabled", "on", "--fog-height-enabled", "on"},
              {"--fog-enabled", "off"}},
             {{"--volumetric-density", "20"}, {"--volumetric-enabled", "on"}, {"--volumetric-enabled", "off"}},
             {{"--vignette-intensity", "0.5"}, {"--vignette-enabled", "on"}, {"--vignette-enabled", "off"}}}) {
        const std::string switched = picture_of(amount);
        EXPECT_NE(switched, plain) << amount.front();
        EXPECT_EQ(switched, picture_of(amount, on)) << amount.front();
        EXPECT_EQ(plain, picture_of(amount, off)) << amount.front();
    }
}

TEST_F(CliRender, WithoutPostProcessingNoEffectIsSeen) {
    ASSERT_EQ(render({"--no-postprocess"}, "plain.png").code, 0);
    std::vector<std::string> flags{"--no-postprocess"};
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0)
            flags.insert(flags.end(), {flag_name(flat_key(effect->name, "enabled")), "on"});
    ASSERT_EQ(render(flags, "on.png").code, 0);
    EXPECT_EQ(content(path("plain.png")), content(path("on.png")));
}

TEST_F(CliRender, EffectsThatAreOffRunNoPass) {
    if (find_effect("ssao") == nullptr) GTEST_SKIP() << "the effect ssao is not in this build";
    const auto passes = [&](std::string_view state) {
        std::vector<std::string> flags{"--timings"};
        for (const EffectInfo* const effect : all_effects())
            if (effect->flat.documented >= 0)
                flags.insert(flags.end(), {flag_name(flat_key(effect->name, "enabled")), std::string(state)});
        const Outcome outcome = render(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        std::size_t count = 0;
        for (std::size_t at = 0; (at = outcome.out.find(" ms  ", at)) != std::string::npos; ++at) ++count;
        EXPECT_NE(outcome.out.find(" ms  together"), std::string::npos) << outcome.out;
        return count - 1;
    };
    EXPECT_GT(passes("on"), 5U);
    EXPECT_EQ(passes("off"), 1U) << "the one that writes the picture";
}

TEST_F(CliRender, RendersAModelAlone) {
    // One triangle: three positions as floats.
    write("one.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36,
"uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    const Outcome outcome = run({"render", path("one.gltf"), "-o", path("one.png"), "--size", "32x32"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.told.find("Entities: 1\n"), std::string::npos) << outcome.told;
    std::set<float> values;
    for (const float value : picture("one.png").pixels) values.insert(value);
    EXPECT_GT(values.size(), 3u) << "the view is fitted to the model";
}

TEST_F(CliRender, MissingAssetsAreNamedAndTheRestRenders) {
    write("gaps.scene.toml", std::string(test::yard_scene) +
                                 "[entities.wall]\nbounds = { min = [0, 0, -2], max = [1, 1, -1.9] }\n"
                                 "material = { texture = \"no_such.png\" }\n"
                                 "[entities.fox.model]\nasset = \"no_such_fox\"\n");
    const Outcome outcome = run({"render", path("gaps.scene.toml"), "-o", path("out.png"), "--size", "16x16"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
    EXPECT_NE(outcome.err.find("no_such.png"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("no_such_fox"), std::string::npos) << outcome.err;
    EXPECT_EQ(picture("out.png").width, 16u);
}

}  // namespace
}  // namespace darkroom
