// SPDX-License-Identifier: MIT
// The command line as its users meet it: the built program is run, and its exit code, its standard error and its files
// are looked at.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using test::content;
using test::Outcome;

class Cli : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(48, 32);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 40.0f;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
    [[nodiscard]] Outcome develop(std::vector<std::string> arguments, const std::string& out = "out.png") const {
        arguments.insert(arguments.begin(), {"develop", path("frame.exr"), "-o", path(out)});
        return run(arguments);
    }
};

TEST_F(Cli, DevelopsAFrame) {
    const Outcome outcome = develop({});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(picture("out.png").width, 48u);
    EXPECT_EQ(files(), (std::vector<std::string>{"frame.exr", "out.png"})) << "nothing else is left behind";
}

TEST_F(Cli, WritesEveryKindOfFile) {
    for (const auto& [name, flags] :
         std::vector<std::pair<std::string, std::vector<std::string>>>{{"a.jpg", {}},
                                                                       {"a.tif", {"--bits", "16"}},
                                                                       {"a.png", {"--bits", "16"}},
                                                                       {"a.exr", {"--bits", "float"}},
                                                                       {"a.hdr", {}}}) {
        const Outcome outcome = develop(flags, name);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "") << name;
        EXPECT_EQ(picture(name).height, 32u);
    }
}

TEST_F(Cli, TheReferenceAgreesWithTheDevice) {
    // Fxaa follows an edge or does not, by less than kernels round.
    ASSERT_EQ(develop({"--fxaa-enabled", "off"}, "gpu.png").code, 0);
    ASSERT_EQ(develop({"--fxaa-enabled", "off", "--reference"}, "cpu.png").code, 0);
    const Result<Comparison> result = compare(picture("cpu.png"), picture("gpu.png"));
    ASSERT_TRUE(result);
    EXPECT_LE(result->max_error, 1.001 / 255);
}

TEST_F(Cli, ResamplesTheFrame) {
    FrameFile halves;
    halves.color = Picture(48, 32);
    for (std::size_t i = 0; i < halves.color.pixels.size(); ++i)
        halves.color.pixels[i] = i % 4 == 3 || i / 4 % 48 >= 24 ? 1.0f : 0.0f;
    ASSERT_TRUE(write_frame(path("halves.exr"), halves));
    write("my.toml", "[[stack]]\neffect = \"encode\"\n");
    const auto at_size = [&](const std::string& size) {
        const Outcome outcome =
            run({"develop", path("halves.exr"), "--look", path("my.toml"), "-o", path("out.png"), "--size", size});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture("out.png");
    };
    for (const auto& [width, height] : {std::pair{20u, 10u}, {96u, 40u}}) {
        const Picture sized = at_size(fmt::format("{}x{}:stretch", width, height));
        ASSERT_TRUE(sized.width == width && sized.height == height) << sized.width << 'x' << sized.height;
        EXPECT_EQ(*sized.at(width / 4, height / 2), 0.0f);
        EXPECT_EQ(*sized.at(width - width / 4, height / 2), 1.0f);
    }
    EXPECT_NEAR(*at_size("1x1").at(0, 0), 0.735, 0.005) << "half of the light as a code value";
}

TEST_F(Cli, SeveralInputsGoToAFolderOrANumberedName) {
    fs::copy_file(path("frame.exr"), path("shot.0007.exr"));
    fs::copy_file(path("frame.exr"), path("shot.0009.exr"));
    const Outcome numbered = run({"develop", path("shot.%04d.exr"), "-o", path("out.%04d.png")});
    EXPECT_EQ(numbered.code, 0) << numbered.err;
    EXPECT_TRUE(fs::exists(path("out.0007.png")) && fs::exists(path("out.0009.png")));
    EXPECT_EQ(std::count(numbered.told.begin(), numbered.told.end(), '\n'), 2)
        << "plain lines where there is no terminal";
    fs::create_directory(path("pictures"));
    EXPECT_EQ(run({"develop", path("shot.0007.exr"), path("frame.exr"), "-o", path("pictures")}).code, 0);
    EXPECT_TRUE(fs::exists(path("pictures/frame.png")) && fs::exists(path("pictures/shot.0007.png")));
    EXPECT_EQ(run({"develop", path("frame.exr"), "-o", path("{name} of {name}.png")}).code, 0);
    EXPECT_TRUE(fs::exists(path("frame of frame.png")));
    expect_refused({"develop", path("shot.0007.exr"), path("frame.exr"), "-o", path("one.png")}, 1, "2 inputs need");
    expect_refused({"develop", path("frame.exr"), path("frame.exr"), "-o", path("{name}.png")}, 1,
                   "two inputs would be written to it");
    // Of a sequence, those that are asked for count.
    const std::string sequence = path("shot.%04d.exr");
    const Outcome nine = run({"develop", sequence, "--frames", "9-13", "-o", path("nine.png")});
    EXPECT_EQ(nine.code, 0);
    EXPECT_NE(nine.err.find("--frames 9-13: no input has these numbers: 11, 13\n"), std::string::npos) << "on twos";
    EXPECT_TRUE(fs::exists(path("nine.png")));
    expect_refused({"develop", sequence, "-o", path("new")}, 1, "2 inputs need a folder (--mkdir makes a new one)");
    EXPECT_EQ(run({"develop", sequence, "--mkdir", "-o", path("new")}).code, 0);
    EXPECT_TRUE(fs::exists(path("new/shot.0007.png")));
    write("box.scene.toml", "");
    expect_refused({"develop", path("box.scene.toml"), "-o", path("one.png")}, 1,
                   "box.scene.toml: is no picture; --look takes a look, and `darkroom render` a scene or a model\n");
}

TEST_F(Cli, WhatChangesNothingOrStandsInAWrongPlaceIsTold) {
    const auto told = [&](const std::vector<std::string>& flags) {
        const Outcome outcome = develop(flags, "out.png");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.err;
    };
    const auto idle = [](const std::string& value, const std::string& entry) {
        return fmt::format("darkroom: warning: {} changes nothing: {} is off; --set {}.enabled=true switches it on\n",
                           value, entry, entry);
    };
    EXPECT_EQ(told({"--lens-flare-ghosts", "3", "--lens-flare-halo", "0.1"}),
              idle("--lens-flare-ghosts", "lens_flare"));
    EXPECT_EQ(told({"--set", "lens_flare.ghosts=3"}), idle("--set lens_flare.ghosts", "lens_flare"));
    EXPECT_EQ(told({"--lens-flare-ghosts", "3", "--lens-flare"}), "");
    EXPECT_EQ(told({"--lens-flare-ghosts", "3", "--no-lens-flare"}), "") << "who says so knows it";
    write("my.toml", "[post_process]\norder = \"scene_linear\"\nlens_flare_ghosts = 3\n");
    const std::vector<std::string> look{"--look", path("my.toml")};
    EXPECT_EQ(told(look),
              fmt::format("darkroom: warning: {}:3:1: lens_flare_ghosts changes nothing: lens_flare is off; "
                          "lens_flare_enabled = true switches it on\n",
                          path("my.toml")));
    EXPECT_EQ(told({"--look", path("my.toml"), "--lens-flare"}), "");
    write("off.toml",
          "[post_process]\norder = \"scene_linear\"\nvignette_smoothness = 0.3\nvignette_enabled = false\n");
    EXPECT_EQ(told({"--look", path("off.toml")}), "");
    EXPECT_EQ(told({"--look", path("off.toml"), "--vignette-smoothness", "0.4"}),
              idle("--vignette-smoothness", "vignette"));
    write("order.toml",
          "[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"color_grade\"\n"
          "[[stack]]\neffect = \"encode\"\n");
    EXPECT_NE(
        told({"--look", path("order.toml")})
            .find("darkroom: warning: color_grade expects a picture that is scene_linear; this one is display_linear."),
        std::string::npos);
}

TEST_F(Cli, HelpIsWhatItPrintsWithoutACommandToo) {
    const std::string help = run({"--help"}).out;
    EXPECT_NE(help.find("Usage: darkroom"), std::string::npos) << help;
    for (const std::vector<std::string>& asked : {std::vector<std::string>{}, {"help"}}) {
        const Outcome outcome = run(asked);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.out, help);
    }
    EXPECT_EQ(run({"help", "lut", "export"}).out, run({"lut", "export", "--help"}).out);
    EXPECT_EQ(run({"help", "develop", "bloom"}).out, run({"develop", "--help", "bloom"}).out);
}

TEST_F(Cli, NoFlagDoesNothing) {
    const std::string all = run({"--help-all"}).out + run({"render", "--help-all"}).out;
    EXPECT_EQ(all.find("oes nothing"), std::string::npos);
    expect_refused({"render", path("a.scene.toml"), "-o", path("x.png"), "--schemas", "a"}, 1,
                   "render: unknown argument '--schemas'");
}

TEST_F(Cli, ALookThatShipsIsNamed) {
    const std::string night = std::string(test::source_folder) + "/looks/night.toml";
    const auto developed = [&](const std::string& flag, const std::string& look) {
        const Outcome outcome = run({"develop", path("frame.exr"), "-o", path("out.png"), flag, look});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return content(path("out.png"));
    };
    EXPECT_EQ(developed("--look", "night"), developed("--look", night));
    EXPECT_EQ(developed("--layer", "daze"),
              developed("--layer", std::string(test::source_folder) + "/looks/daze.toml"));
    EXPECT_EQ(run({"plan", "night"}).out, run({"plan", night}).out);
    EXPECT_EQ(run({"info", "night"}).code, 0);
    EXPECT_EQ(run({"lut", "export", "clean", "-o", path("clean.cube")}).code, 0);
    expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), "--look", "nigt"}, 1,
                   "--look: nigt: no such file, and no look that ships has this name, did you mean 'night'?");
    // A file of this name is what was meant.
    write("night", "format = 1\n[post_process]\nexposure = 0.25\n");
    const Outcome own = run_lines("darkroom plan night --as-stack");
    EXPECT_NE(own.out.find("exposure = 0.25"), std::string::npos) << own.out << own.err;
}

TEST_F(Cli, APlanWithoutAFrameSaysNotWhatItLacks) {
    const std::string look = write("dark.toml", "format = 1\n[[stack]]\neffect = \"ssao\"\n");
    EXPECT_NE(run({"plan", look}).out.find("left out: ssao: needs depth; no frame is named, --input FRAME does\n"),
              std::string::npos);
    EXPECT_NE(run({"plan", look, "--input", path("frame.exr")}).out.find("which the frame does not have"),
              std::string::npos);
}

TEST_F(Cli, DevicesAreToldToPrograms) {
    const Outcome text = run({"devices"}), told = run({"devices", "--json"});
    EXPECT_EQ(text.code, told.code);
    const auto devices = nlohmann::json::parse(told.out, nullptr, false);
    ASSERT_TRUE(devices.is_array()) << told.out << told.err;
    std::string lines;
    for (const auto& device : devices) {
        lines += fmt::format("{}: {} | {} | Vulkan {} | {}", device.at("index").get<int>(),
                             device.at("name").get<std::string>(), device.at("driver").get<std::string>(),
                             device.at("vulkan").get<std::string>(), device.at("kind").get<std::string>());
        if (!device.at("usable").get<bool>()) lines += " | not usable: " + device.at("reason").get<std::string>();
        lines += "\n";
    }
    EXPECT_EQ(text.out, lines);
}

TEST_F(Cli, WrongRequestsAreOneLineAndOne) {
    const std::string frame = path("frame.exr"), out = path("x.png");
    expect_refused({"help", "devlop"}, 1, "unknown command 'devlop', did you mean 'develop'? allowed is render, ");
    if (find_effect("bloom") != nullptr)
        expect_refused({"help", "bloom"}, 1, "help bloom: it is an effect: darkroom effects bloom tells of it, ");
    expect_refused({"help", "develop", "blom"}, 1, "no such effect, did you mean 'bloom'?");
    expect_refused({"devlop"}, 1, "unknown command 'devlop', did you mean 'develop'? allowed is render, develop, ");
    expect_refused({"qqqqqqqq"}, 1, "unknown command 'qqqqqqqq': allowed is render, develop, ");
    expect_refused({"farm", "status", ".", "--jsn"}, 1,
                   "farm status: unknown argument '--jsn', did you mean '--json'?");
    expect_refused({"farm"}, 1, "farm: a command is needed: slurm, task, status");
    expect_refused({"develop", frame, "-o", out, "--chromatic-aberration-intensity", "1"}, 1,
                   "did you mean '--chromatic-aberration'?");
    expect_refused({"develop"}, 1, "INPUT");
    expect_refused({"develop", frame}, 1, "-o OUT is needed");
    expect_refused({"develop", path("none.exr"), "-o", out}, 1, "none.exr");
    expect_refused({"develop", path(""), "-o", out}, 1, "folder");
    expect_refused({"develop", write("text.exr", "hello"), "-o", out}, 1, "text.exr");
    expect_refused({"develop", frame, "--vignette", "0.5", "-o", out}, 1,
                   "--vignette: takes no value, did you mean '--vignette-intensity 0.5'?");
    expect_refused({"develop", frame, "-o", path("none/x.png")}, 1, "none");
    expect_refused({"develop", frame, "-o", path("x.xyz")}, 1, ".xyz");
    expect_refused({"develop", frame, "-o", frame}, 1, "would be overwritten");
    for (const char* const size : {"0x0", "5", "5x", "-1x4", "4294967297x1", "3x4x5"})
        expect_refused({"develop", frame, "-o", out, "--size", size}, 1, "--size");
    expect_refused({"develop", frame, "-o", out, "--size", "99999x2:stretch"}, 1, "allows 1x1 to");
    expect_refused({"develop", frame, "-o", out, "--device", "none such"}, 1, "none such");
    expect_refused({"develop", frame, "-o", out, "--kernels", "magic"}, 1, "auto, compute or raster");
    expect_refused({"develop", frame, "-o", out, "--bits", "12"}, 1, "--bits 12");
    expect_refused({"develop", frame, "-o", out, "--map", "depth=nothing"}, 1, "nothing");
    expect_refused({"develop", frame, "-o", out, "--look", path("none.toml")}, 1, "none.toml");
    expect_refused({"develop", frame, "-o", out, "--order", "sideways"}, 1, "documented or scene_linear");
    expect_refused({"develop", frame, "-o", out, "--set", "nonsense"}, 1, "ENTRY.PARAM=VALUE");
    expect_refused({"develop", frame, "-o", out, "--no-such-flag"}, 1, "--no-such-flag");
    expect_refused({"plan", path("none.toml")}, 1, "none.toml");
    expect_refused({"effects", "none such"}, 1, "none such");
    expect_refused({"compare", frame, path("none.exr")}, 1, "none.exr");
}

TEST_F(Cli, EveryParameterIsAFlag) {
    const std::string help = run({"develop", "--help-all"}).out;
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows) {
            const std::string flag = flag_name(flat_key(effect->name, row.name));
            EXPECT_NE(help.find(flag + " "), std::string::npos) << flag;
            if (effect->flat.documented < 0 || row.kind == Kind::Choice || row.kind == Kind::Curve) continue;
            expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), flag, "no value"}, 1, flag);
        }
}

TEST_F(Cli, FlagsWinOverTheLookWhichWinsOverDefaults) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect exposure is not in this build";
    const std::string look = write("a.toml", "[post_process]\norder = \"scene_linear\"\nexposure = 2.0\n");
    ASSERT_EQ(develop({}, "default.png").code, 0);
    ASSERT_EQ(develop({"--look", look}, "look.png").code, 0);
    ASSERT_EQ(develop({"--exposure", "2"}, "flag.png").code, 0);
    ASSERT_EQ(develop({"--look", look, "--exposure", "1"}, "both.png").code, 0);
    EXPECT_NE(picture("default.png"), picture("look.png"));
    EXPECT_EQ(picture("flag.png"), picture("look.png"));
    EXPECT_EQ(picture("both.png"), picture("default.png"));
}

TEST_F(Cli, PostProcessingOffIsTheDefaultCurveAtTheLooksExposure) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect exposure is not in this build";
    ASSERT_EQ(develop({"--no-postprocess", "--exposure", "4", "--tonemap-curve", "agx"}, "off.png").code, 0);
    std::vector<std::string> all_off{"--exposure", "4"};
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0 && effect->makes == nullptr && effect->name != "exposure")
            all_off.insert(all_off.end(), {flag_name(flat_key(effect->name, "enabled")), "off"});
    ASSERT_EQ(develop(all_off, "all_off.png").code, 0);
    const Result<Comparison> result = compare(picture("off.png"), picture("all_off.png"));
    ASSERT_TRUE(result);
    EXPECT_LE(result->max_error, 2.001 / 255);
}

TEST_F(Cli, WhatIsOffTakesNoPassAndNoMemory) {
    std::vector<std::string> arguments{"plan", "--input", path("frame.exr")};
    const Outcome usual = run(arguments);
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0 && effect->makes == nullptr)
            arguments.insert(arguments.end(), {flag_name(flat_key(effect->name, "enabled")), "off"});
    const Outcome bare = run(arguments);
    EXPECT_EQ(bare.code, 0) << bare.err;
    EXPECT_NE(bare.out.find("transient memory: 0.00 MiB"), std::string::npos) << bare.out;
    for (const EffectInfo* const effect : all_effects()) {
        if (effect->flat.documented < 0 || effect->makes != nullptr) continue;
        EXPECT_EQ(bare.out.find(effect->name), std::string::npos) << bare.out;
        if (effect->flat.starts_on) continue;
        EXPECT_EQ(usual.out.find(effect->name), std::string::npos) << usual.out;
    }
}

TEST_F(Cli, LooksWarnOrStrictlyRefuse) {
    const std::string look = write("a.toml", "[post_process]\nbogus_key = 1\n");
    const Outcome lenient = develop({"--look", look});
    EXPECT_EQ(lenient.code, 0);
    EXPECT_NE(lenient.err.find("darkroom: warning: " + look + ":2:1: unknown key 'bogus_key'"), std::string::npos)
        << lenient.err;
    expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), "--look", look, "--strict"}, 1, "bogus_key");
}

TEST_F(Cli, AnExistingPictureSurvivesAFailure) {
    const std::string kept = write("kept.png", "kept");
    EXPECT_EQ(run({"develop", write("bad.exr", "bad"), "-o", kept}).code, 1);
    EXPECT_EQ(content(kept), "kept");
}

TEST_F(Cli, ComparesPictures) {
    ASSERT_EQ(develop({}, "a.png").code, 0);
    ASSERT_EQ(develop({"--no-postprocess"}, "b.png").code, 0);
    EXPECT_EQ(run({"compare", path("a.png"), path("a.png"), "--fail-above", "0"}).code, 0);
    const Outcome differs =
        run({"compare", path("a.png"), path("b.png"), "--fail-above", "0", "--diff", path("d.png")});
    EXPECT_EQ(differs.code, 3);
    EXPECT_NE(differs.err.find("is above 0"), std::string::npos) << differs.err;
    EXPECT_NE(differs.out.find("FLIP mean"), std::string::npos) << differs.out;
    EXPECT_EQ(picture("d.png").width, 48u);
    expect_refused({"compare", path("a.png"), path("frame.exr")}, 1, "cannot be compared");
}

// The stack that a table stands for develops to the table's own picture, whichever of the two orders it has.
TEST_F(Cli, ATableIsPrintedAsItsStack) {
    for (const char* const name : {"default", "documented", "scene_linear", "bright"}) {
        const std::string look = std::string(test::source_folder) + "/looks/" + name + ".toml";
        const Outcome printed = run({"plan", look, "--as-stack"});
        ASSERT_EQ(printed.code, 0) << printed.err;
        EXPECT_NE(printed.out.find("[[stack]]\neffect = \"bloom\"\n"), std::string::npos) << printed.out;
        EXPECT_EQ(printed.out.find("[post_process]"), std::string::npos);
        const std::string stack = write("stack.toml", printed.out),
                          frame = std::string(test::source_folder) + "/samples/window.exr";
        ASSERT_EQ(run({"develop", frame, "--look", look, "-o", path("table.png")}).code, 0);
        ASSERT_EQ(run({"develop", frame, "--look", stack, "-o", path("stack.png")}).code, 0);
        EXPECT_EQ(test::content(path("table.png")), test::content(path("stack.png"))) << name;
    }
}

TEST_F(Cli, ASceneIsPlannedWithWhatItsRendererGives) {
    const Outcome plan = run({"plan", std::string(test::source_folder) + "/scenes/dungeon.scene.toml"});
    ASSERT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(plan.out.find("left out"), std::string::npos) << plan.out;
    for (const char* const effect : {"ssao", "volumetric"})
        EXPECT_NE(plan.out.find(effect), std::string::npos) << effect;
}

TEST_F(Cli, TellsPlansEffectsAndDevices) {
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--version"},
                                               {"--help"},
                                               {"plan"},
                                               {"plan", "--json"},
                                               {"plan", "--input", path("frame.exr")},
                                               {"effects"},
                                               {"devices"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << arguments[0] << ": " << outcome.err;
        EXPECT_GT(outcome.out.size(), 5u) << arguments[0];
    }
    for (const EffectInfo* const effect : all_effects()) {
        const Outcome page = run({"effects", std::string(effect->name)});
        EXPECT_EQ(page.code, 0);
        for (const ParamInfo& row : effect->parameters.rows)
            EXPECT_NE(page.out.find("| `" + flat_key(effect->name, row.name) + "`"), std::string::npos) << effect->name;
    }
}

TEST_F(Cli, EffectsAreListedForPrograms) {
    const Outcome all = run({"effects", "--json"});
    ASSERT_EQ(all.code, 0) << all.err;
    for (const EffectInfo* const effect : all_effects()) {
        EXPECT_NE(all.out.find(fmt::format("\"name\": \"{}\"", effect->name)), std::string::npos) << effect->name;
        for (const ParamInfo& row : effect->parameters.rows) {
            const std::string key = flat_key(effect->name, row.name);
            const std::string line = fmt::format("\"key\": \"{}\",\n        \"flag\": \"{}\"", key, flag_name(key));
            const std::size_t at = all.out.find(line);
            ASSERT_NE(at, std::string::npos) << key;
            constexpr std::string_view mark = "\"at_compile\": ";
            EXPECT_EQ(all.out.substr(all.out.find(mark, at) + mark.size(), 4) == "true", row.is_at_compile) << key;
        }
    }
    if (find_effect("fog") == nullptr) return;
    const std::string fog = run({"effects", "fog", "--json"}).out;
    for (const char* const part :
         {"\"type\": \"rgb\"", "\"default\": 0.005", "\"unit\": \"1/m\"", "\"min\": 0.001", "\"max\": 1000000000.0",
          "\"depth\"", "\"switches_effect\": true", "\"toggle_key\": 8"})
        EXPECT_NE(fog.find(part), std::string::npos) << part << " is not in " << fog;
    EXPECT_EQ(fog.find("\"vignette\""), std::string::npos);
    EXPECT_NE(run({"effects", "fog"}).out.find("by F8."), std::string::npos);
    EXPECT_EQ(run({"effects", "encode"}).out.find("viewer"), std::string::npos);
}

TEST_F(Cli, HostileFilesDevelopOrAreRefusedWhole) {
    const char* const data = std::getenv("DARKROOM_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    std::size_t count = 0;
    for (const auto& file : fs::directory_iterator(fs::path(data) / "hostile")) {
        const std::string extension = file.path().extension().string();
        if (extension != ".exr" && extension != ".hdr") continue;
        ++count;
        const Outcome outcome = run({"develop", file.path().string(), "-o", path("x.png")});
        EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << file.path() << " " << outcome.err;
        EXPECT_EQ(fs::exists(path("x.png")), outcome.code == 0) << file.path();
        const bool names_file = outcome.err.find(file.path().filename().string()) != std::string::npos;
        EXPECT_TRUE(outcome.code == 0 || names_file) << outcome.err;
        fs::remove(path("x.png"));
        EXPECT_EQ(files(), std::vector<std::string>{"frame.exr"});
    }
    EXPECT_GE(count, 7u);
    for (const auto& file : fs::directory_iterator(fs::path(data) / "hostile"))
        if (file.path().extension() == ".toml")
            expect_refused(
                {"develop", path("frame.exr"), "-o", path("x.png"), "--look", file.path().string(), "--strict"}, 1,
                file.path().filename().string());
}

}  // namespace
}  // namespace darkroom
