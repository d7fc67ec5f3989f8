// SPDX-License-Identifier: MIT
// What the hands of people who know other command lines type: the same outcome, whichever way they say it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliHabits : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(24, 16);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 40.0f;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        write("empty.scene.toml", "[scene]\nname = \"empty\"\n");
    }
    /// The bytes of the picture that these flags make of the frame.
    [[nodiscard]] std::string developed(std::vector<std::string> flags) const {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-o", path("out.png")});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return content(path("out.png"));
    }
};

TEST_F(CliHabits, AnOutputHasALongName) {
    for (const char* const name : {"-o", "--output", "--out"}) {
        const std::string file = path(fmt::format("{}.png", name)), cube = path(fmt::format("{}.cube", name));
        EXPECT_EQ(run({"develop", path("frame.exr"), name, file}).code, 0) << name;
        EXPECT_EQ(run({"render", path("empty.scene.toml"), "--size", "8x8", name, file}).code, 0) << name;
        EXPECT_EQ(run({"lut", "export", name, cube}).code, 0) << name;
        EXPECT_EQ(run({"lut", "convert", cube, name, path("b.cube")}).code, 0) << name;
    }
}

TEST_F(CliHabits, AFrameIsSavedUnderBothNames) {
    for (const char* const name : {"--save-frame", "--frame"}) {
        const std::string file = path(fmt::format("{}.exr", name));
        const Outcome outcome =
            run({"render", path("empty.scene.toml"), "--size", "8x8", "-o", path("a.png"), name, file});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_TRUE(read_frame(file)) << name;
    }
}

TEST_F(CliHabits, EffectsAreSwitchedByTheirNames) {
    for (const char* const name : {"dither", "bloom", "exposure"})
        if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
    const std::string plain = developed({"--dither-enabled", "off"}), dithered = developed({"--dither-enabled", "on"});
    EXPECT_EQ(developed({}), dithered) << "on by itself";
    EXPECT_NE(plain, dithered);
    EXPECT_EQ(developed({"--dither"}), dithered);
    EXPECT_EQ(developed({"--dither", "--no-dither"}), plain);
    EXPECT_EQ(developed({"--no-dither", "--dither"}), dithered);
    EXPECT_EQ(developed({"--no-dither", "--dither-enabled", "on"}), dithered) << "what was typed last counts";
    EXPECT_EQ(developed({"--dither-enabled", "on", "--no-dither"}), plain);
    EXPECT_EQ(developed({"--no-bloom"}), developed({"--bloom-enabled", "off"}));
    EXPECT_NE(developed({"--no-bloom"}), dithered);
    EXPECT_EQ(developed({"--no-exposure", "--exposure", "2"}), dithered) << "switched off, whatever its value";
    expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), "--exposure"}, 1, "one value is needed");
}

TEST_F(CliHabits, ExposureTakesStops) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect exposure is not in this build";
    const std::string brighter = developed({"--exposure", "2"});
    EXPECT_NE(brighter, developed({}));
    EXPECT_EQ(developed({"--exposure", "1ev"}), brighter);
    EXPECT_EQ(developed({"--exposure=-1EV"}), developed({"--exposure", "0.5"}));
    EXPECT_EQ(developed({"--set", "exposure.exposure=1ev"}), brighter);
    for (const char* const text : {"ev", "one ev", "1sto"})
        expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), "--exposure", text}, 1,
                       fmt::format("--exposure: '{}' is not a number, allowed is [0, 1024] x", text));
    expect_refused({"develop", path("frame.exr"), "-o", path("x.png"), "--exposure", "11ev"}, 1,
                   "--exposure = 2048: allowed is [0, 1024] x");
}

TEST_F(CliHabits, WhatIsAskedForAndLeftOutIsTold) {
    if (find_effect("ssao") == nullptr) GTEST_SKIP() << "the effect ssao is not in this build";
    const std::string warning = "darkroom: warning: left out: ssao: needs depth, which the frame does not have\n";
    const auto said = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-o", path("a.png")});
        return run(flags).err;
    };
    const auto look = [&](const std::string& line) {
        return std::vector<std::string>{"--look", write("a.toml", "[post_process]\n" + line + "\n")};
    };
    EXPECT_EQ(said({}), "") << "the table has it on by itself";
    EXPECT_EQ(said(look("exposure = 2.0")), "");
    EXPECT_EQ(said(look("ssao_enabled = false")), "");
    EXPECT_EQ(said({"--no-ssao"}), "");
    EXPECT_EQ(said({"--ssao"}), warning);
    EXPECT_EQ(said({"--ssao-enabled", "on"}), warning);
    EXPECT_EQ(said({"--ssao-intensity", "1"}), warning);
    EXPECT_EQ(said(look("ssao_enabled = true")), warning);
    EXPECT_EQ(said(look("ssao_intensity = 1")), warning);
    EXPECT_EQ(said({"--ssao", "--no-ssao"}), "");
}

TEST_F(CliHabits, QuietIsSilentAndVerboseSaysMore) {
    const std::vector<std::string> develop{"develop", path("frame.exr"), "-o", path("a.png")};
    const auto with = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), develop.begin(), develop.end());
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome;
    };
    EXPECT_NE(with({}).told, "");
    EXPECT_EQ(with({}).err, "");
    for (const char* const flag : {"-q", "--quiet"}) {
        EXPECT_EQ(with({flag}).told, "");
        EXPECT_NE(with({flag, "--timings"}).out.find("together"), std::string::npos) << "what was asked for is told";
    }
    EXPECT_EQ(run({"render", path("empty.scene.toml"), "--size", "8x8", "-q", "-o", path("b.png")}).told, "");
    EXPECT_EQ(run({"compare", "-q", path("a.png"), path("a.png")}).out, "");
    EXPECT_NE(run({"compare", "-q", "--json", path("a.png"), path("a.png")}).out, "");
    for (const char* const flag : {"-v", "--verbose"}) {
        EXPECT_NE(with({flag}).err.find("darkroom: device: "), std::string::npos);
        if (find_effect("ssao") == nullptr) continue;
        EXPECT_NE(with({flag, "--look", path("empty.scene.toml")}).err.find("darkroom: left out: ssao: needs depth"),
                  std::string::npos);
    }
    expect_refused({"develop", "-q", path("none.exr"), "-o", path("x.png")}, 1, "none.exr");
}

// Without a display they are as far as the window when they end.
TEST_F(CliHabits, FlagsOfWindowsAreTaken) {
    EXPECT_NE(run({"play", "--help-keys"}).out.find("walks; with Shift it runs  [play]"), std::string::npos);
    unsetenv("DISPLAY");
    expect_refused({"edit", path("empty.scene.toml"), "--auto-orbit", "--fullscreen"}, 2, "no window can be opened");
}

class CliHelp : public CliHabits {
  protected:
    /// What stands below a head of a help text.
    [[nodiscard]] static std::vector<std::string> below(const std::string& text, const std::string& head) {
        std::istringstream lines(text);
        std::vector<std::string> out;
        bool is_inside = false;
        for (std::string line; std::getline(lines, line);) {
            if (is_inside && line.empty()) break;
            if (is_inside) out.push_back(line.substr(std::min<std::size_t>(2, line.size())));
            is_inside |= line == head;
        }
        return out;
    }
    /// The arguments that name a command, for each of them, in the order of the help.
    [[nodiscard]] std::vector<std::vector<std::string>> commands(const std::vector<std::string>& of = {}) const {
        std::vector<std::string> help = of;
        help.emplace_back("--help");
        std::vector<std::vector<std::string>> out;
        for (const std::string& line : below(run(help).out, "Commands:")) {
            if (line.starts_with(' ')) continue;
            std::vector<std::string> named = of;
            named.push_back(line.substr(0, line.find(' ')));
            out.push_back(named);
            for (auto& child : commands(named)) out.push_back(std::move(child));
        }
        return out;
    }
};

TEST_F(CliHelp, IsShortAndSaysWhereTheRestIs) {
    const Outcome help = run({"develop", "--help"});
    ASSERT_EQ(help.code, 0) << help.err;
    EXPECT_LE(std::ranges::count(help.out, '\n'), 90);
    EXPECT_EQ(run({"develop", "-h"}).out, help.out);
    EXPECT_EQ(run({"develop", "none.exr", "--no-such-flag", "--help"}).out, help.out) << "all else need not be right";
    EXPECT_EQ(run({"develop", "--help", "none.exr"}).out, help.out);
    EXPECT_EQ(run({"--help", "develop"}).out, help.out);
    const Outcome all = run({"develop", "--help-all"});
    EXPECT_GT(std::ranges::count(all.out, '\n'), 300);
    std::istringstream lines(all.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
    for (const EffectInfo* const effect : all_effects()) {
        const Outcome one = run({"develop", "--help", std::string(effect->name)});
        EXPECT_EQ(one.code, 0) << one.err;
        for (const ParamInfo& row : effect->parameters.rows) {
            const std::string flag = "  " + flag_name(flat_key(effect->name, row.name)) + " ";
            EXPECT_NE(one.out.find(flag), std::string::npos) << flag;
            EXPECT_NE(all.out.find(flag), std::string::npos) << flag;
            EXPECT_EQ(help.out.find(flag), std::string::npos) << flag;
        }
    }
    EXPECT_NE(run({"--help-all"}).out.find("--fail-flip"), std::string::npos);
    expect_refused({"develop", "--help", "blom"}, 1, "--help blom: no such effect, did you mean 'bloom'?");
    expect_refused({"devices", "--help", "bloom"}, 1, "devices has no flags of effects");
}

TEST_F(CliHelp, ListsWhatUsersNeedAndLeavesTheLabToItsProgram) {
    std::vector<std::string> names;
    for (const std::string& line : below(run({"--help"}).out, "Commands:"))
        if (!line.starts_with(' ')) names.push_back(line.substr(0, line.find(' ')));
    EXPECT_LE(names.size(), 15U) << fmt::format("{}", fmt::join(names, " "));
    EXPECT_GE(names.size(), 10U);
    const Outcome lab = run_lines("darkroom_lab --help");
    EXPECT_NE(lab.out.find("Usage: darkroom_lab COMMAND\n"), std::string::npos) << lab.out;
    for (const char* const name : {"api", "capture", "judge"}) {
        EXPECT_NE(run_lines(fmt::format("darkroom {}", name)).err.find("unknown command"), std::string::npos) << name;
        EXPECT_NE(lab.out.find(fmt::format("\n  {} ", name)), std::string::npos) << name;
    }
}

TEST_F(CliHelp, EveryCommandHasThreeExamplesThatRun) {
    for (const char* const name : {"shot.0001.exr", "shot.0002.exr"})
        std::filesystem::copy_file(path("frame.exr"), path(name));
    std::filesystem::copy_file(path("empty.scene.toml"), path("scene.toml"));
    write("my.toml", "[post_process]\nexposure = 1.5\n");
    const std::string cube = "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n";
    write("film.cube", cube);
    write("bright.cube", cube);
    ASSERT_EQ(run({"develop", path("frame.exr"), "--size", "16x4:stretch", "-o", path("strip.png")}).code, 0);
    ASSERT_EQ(run({"develop", path("frame.exr"), "-o", path("reference.png")}).code, 0);
    write("film.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n1\n}\n");
    for (const char* const folder : {"expected", "pictures"}) {
        std::filesystem::create_directory(path(folder));
        std::filesystem::copy_file(path("reference.png"), path(std::string(folder) + "/a.png"));
    }
    std::filesystem::copy_file(path("reference.png"), path("changed.png"));
    unsetenv("DISPLAY");
    std::vector<std::vector<std::string>> all = commands();
    ASSERT_GE(all.size(), 10U);
    all.emplace_back();
    for (std::vector<std::string> command : all) {
        command.emplace_back("--help");
        const std::vector<std::string> examples = below(run(command).out, "Examples:");
        EXPECT_EQ(examples.size(), 3U) << command.front();
        // Without a display there is nothing but the end of the checks.
        const bool needs_display = command.front() == "play" || command.front() == "edit";
        for (std::string example : examples) {
            // Every kernel takes minutes, and CliVerify tries what it says of them: here one effect's do.
            if (command.front() == "verify" && example.find("--effect") == std::string::npos)
                example += " --effect exposure";
            const Outcome outcome = run_lines(example);
            EXPECT_EQ(outcome.code, needs_display ? 2 : 0) << example << "\n" << outcome.err;
        }
    }
}

}  // namespace
}  // namespace darkroom
