// SPDX-License-Identifier: MIT
// What flags refuse, and in which words: one line that names flag, value and what is allowed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "programs/darkroom/flags/flags.hpp"

namespace darkroom {
namespace {

class CliFlags : public test::CliFixture {
  protected:
    void make_files() override {
        write("box.scene.toml", "[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n");
        FrameFile frame;
        frame.color = Picture(8, 8);
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
    /// A command with all that it needs, and more.
    [[nodiscard]] std::vector<std::string> command(const std::string& name,
                                                   const std::vector<std::string>& more) const {
        std::vector<std::string> out{name};
        if (name == "render") out = {"render", path("box.scene.toml"), "-o", path("x.png")};
        if (name == "develop") out = {"develop", path("frame.exr"), "-o", path("x.png")};
        if (name == "compare") out = {"compare", path("frame.exr"), path("frame.exr")};
        out.insert(out.end(), more.begin(), more.end());
        return out;
    }
};

TEST_F(CliFlags, EveryNumberIsRefusedWithFlagValueAndRange) {
    struct Case {
        const char *command, *flag, *value, *error;
    };
    const Case cases[] = {
        {"render", "--width", "1e30", " = 1e30: allowed is [1, 1000000] px"},
        {"render", "--height", "4.5", ": '4.5' is not a whole number, allowed is [1, 1000000] px"},
        {"render", "--time", "-1", " = -1: allowed is [0, 1000000000] s"},
        {"render", "--fps", "0", " = 0: allowed is [0.001, 1000000]"},
        {"render", "--seed", "-1", " = -1: allowed is [0, 9007199254740991]"},
        {"render", "--distance", "0", " = 0: allowed is (0, 1000000000) m"},
        {"render", "--yaw", "inf", ": 'inf' is not a number, allowed is [-1000000, 1000000] deg"},
        {"render", "--pitch", "90.5", " = 90.5: allowed is [-90, 90] deg"},
        {"render", "--fov", "x", ": 'x' is not a number, allowed is (0, 180) deg"},
        {"render", "--shadow-resolution", "15", " = 15: allowed is [16, 16384] texels"},
        {"render", "--shadow-filter", "sofd", " sofd, did you mean 'soft'? allowed is plain or soft"},
        {"render", "--msaa", "abc", ": 'abc' is not a whole number, allowed is [1, 64]"},
        {"develop", "--fov", "nan", ": 'nan' is not a number, allowed is (0, 180) deg"},
        {"develop", "--time", "1e30", " = 1e30: allowed is [0, 1000000000] s"},
        {"compare", "--fail-above", "1.5", " = 1.5: allowed is [0, 1]"},
    };
    for (const auto& [name, flag, value, error] : cases)
        expect_refused(command(name, {flag, value}), 1, fmt::format("darkroom: {}{}\n", flag, error));
}

TEST_F(CliFlags, AnEmptyTextIsNoValue) {
    for (const auto& [name, flag] : std::vector<std::pair<std::string, std::string>>{{"render", "--width"},
                                                                                     {"render", "--device"},
                                                                                     {"develop", "--camera"},
                                                                                     {"plan", "--size"},
                                                                                     {"plan", "LOOK"}})
        expect_refused(flag == "LOOK" ? command(name, {""}) : command(name, {flag, ""}), 1,
                       flag + ": one value is needed\n");
    expect_refused(command("develop", {"--exposure", ""}), 1, "--exposure: '' is not a number, allowed is");
}

TEST_F(CliFlags, AFlagIsNoValueOfTheOneBefore) {
    // Once where the one that is taken along was needed, and once where not.
    expect_refused({"develop", "a.exr", "--bloom-intensity", "--output", "a.png"}, 1,
                   "darkroom: --bloom-intensity: one value is needed, before '--output'\n");
    expect_refused({"develop", "a.exr", "-o", "a.png", "--size", "--exposure=2"}, 1,
                   "darkroom: --size: one value is needed, before '--exposure=2'\n");
    expect_refused({"develop", "a.exr", "--look", "-o", "a.png"}, 1,
                   "darkroom: --look: one value is needed, before '-o'\n");
    expect_refused({"render", "a.toml", "--frames", "-o", "a.png"}, 1,
                   "darkroom: --frames: one value is needed, before '-o'\n");
    for (const auto& [flag, value, meant] : {std::array{"--vignette", "0.5", "--vignette-intensity 0.5"},
                                             {"--tonemap", "agx", "--tonemap-curve agx"},
                                             {"--bloom", "0.2", "--bloom-intensity 0.2"}})
        expect_refused({"develop", "a.exr", flag, value, "-o", "a.png"}, 1,
                       fmt::format("darkroom: {}: takes no value, did you mean '{}'?\n", flag, meant));
    // Files behind a switch are files, as far as there are some.
    for (const char* const input : {"none.exr", "none.$F4.exr"})
        expect_refused({"develop", "--bloom", input, "-o", "a.png"}, 1, "darkroom: none");
    expect_refused({"develop", "a.exr"}, 1, "darkroom: develop: -o OUT is needed: The picture: ");
    expect_refused({"develop"}, 1, "darkroom: develop: INPUT is needed: Frames or pictures");
    expect_refused({"develop", "a.exr", "--exposre", "2"}, 1, "did you mean '--exposure'?\n");
}

TEST_F(CliFlags, WhatStandsTwiceOrIsNoSwitchIsTold) {
    for (const std::string flag : {"--output", "--size", "--device"})
        expect_refused(
            command("render", {flag, "8x8", flag, "9x9", flag, "7x7"}), 1,
            fmt::format("darkroom: {}: stands {} times, once is allowed\n", flag, flag == "--output" ? 4 : 3));
    expect_refused(command("develop", {"--strict=maybe"}), 1, "darkroom: --strict = maybe: allowed is true or false\n");
}

// Without the program: a process takes longer than all of them.
class NumberFlagTest : public testing::Test {
  protected:
    [[nodiscard]] static std::string read(const app::NumberRange& range, std::vector<std::string> arguments) {
        CLI::App program;
        app::NumberFlag flag("--flag", range);
        flag.add_to(app::CommandFlags(program), "A number");
        std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
        program.parse(arguments);
        const Result<std::optional<double>> value = flag.value();
        if (!value) return value.error().text;
        return *value ? fmt::format("{}", **value) : "nothing";
    }
};

TEST_F(NumberFlagTest, NumbersOfTheRangeAreTaken) {
    const app::NumberRange closed{.least = -90, .most = 90}, open{.least = 0, .most = 180, .is_open = true};
    const app::NumberRange seeds{.least = 0, .most = 9007199254740991, .is_whole = true};
    EXPECT_EQ(read(closed, {}), "nothing");
    for (const char* const text : {"-90", "90", "-5.5", "0"}) EXPECT_EQ(read(closed, {"--flag", text}), text);
    EXPECT_EQ(read(closed, {"--flag=-30"}), "-30");
    EXPECT_EQ(read(closed, {"--flag", "+3"}), "3");
    EXPECT_EQ(read(open, {"--flag", "179.9"}), "179.9");
    EXPECT_EQ(read(seeds, {"--flag", "9007199254740991"}), "9007199254740991");
    EXPECT_EQ(read(seeds, {"--flag", "1e3"}), "1000");
}

TEST_F(NumberFlagTest, EverythingElseIsRefusedInOneLine) {
    const app::NumberRange closed{.least = -90, .most = 90, .unit = "deg"};
    const app::NumberRange open{.least = 0, .most = 180, .is_open = true};
    const app::NumberRange whole{.least = 1, .most = 64, .is_whole = true};
    for (const std::string text : {"", "abc", "nan", "inf", "-inf", "12abc", "0x10", " 3", "3 ", "1,5", "1e999"}) {
        EXPECT_EQ(read(closed, {"--flag", text}), "--flag: '" + text + "' is not a number, allowed is [-90, 90] deg");
        EXPECT_EQ(read(whole, {"--flag", text}), "--flag: '" + text + "' is not a whole number, allowed is [1, 64]");
    }
    for (const std::string text : {"-90.001", "1e30", "99999999999999999999"})
        EXPECT_EQ(read(closed, {"--flag", text}), "--flag = " + text + ": allowed is [-90, 90] deg");
    for (const std::string text : {"0", "180", "-1"})
        EXPECT_EQ(read(open, {"--flag", text}), "--flag = " + text + ": allowed is (0, 180)");
    EXPECT_EQ(read(whole, {"--flag", "1.5"}), "--flag: '1.5' is not a whole number, allowed is [1, 64]");
    EXPECT_EQ(read(whole, {"--flag", "0"}), "--flag = 0: allowed is [1, 64]");
}

}  // namespace
}  // namespace darkroom
