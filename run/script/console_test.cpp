// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "script/console_state.hpp"
#include "script/test_stack.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;
using test::ConsoleBed;

class Folder {
  public:
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ostringstream out;
        out << std::ifstream(path / name).rdbuf();
        return out.str();
    }
    const fs::path path = fs::temp_directory_path() / (std::string("darkroom_console_") +
                                                       ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                                                       std::to_string(::getpid()));
};

std::string grammar(std::string_view text) {
    std::string out;
    script::CommandReader reader(text);
    while (const auto command = reader.next()) {
        out += std::to_string(command->line) + ":";
        for (const std::string_view word : command->words) out += "[" + std::string(word) + "]";
        out += " ";
    }
    return out;
}

TEST(ConsoleGrammar, WordsQuotesSemicolonsAndComments) {
    EXPECT_EQ(grammar("a 1;b  2\r\n\tc\n"), "1:[a][1] 1:[b][2] 2:[c] ");
    EXPECT_EQ(grammar("a \"x; y // z\" w"), "1:[a][x; y // z][w] ");
    EXPECT_EQ(grammar("a // b; c\nd //\n//e\nf"), "1:[a] 2:[d] 4:[f] ");
    EXPECT_EQ(grammar("path a//b"), "1:[path][a//b] ") << "a comment begins where a word may";
    EXPECT_EQ(grammar("a \"open\nb"), "1:[a][open] 2:[b] ") << "a line ends a quote";
    EXPECT_EQ(grammar("a \"\"\"b\""), "1:[a][][b] ");
    EXPECT_EQ(grammar(";;\n \n;"), "");
    EXPECT_EQ(grammar("\""), "1:[] ");
    EXPECT_EQ(grammar(std::string_view("a\0b\x7f"
                                       "c",
                                       5)),
              "1:[a][b][c] ");
}

TEST(Console, AVariableIsAParameterUnderBothItsNames) {
    ConsoleBed bed;
    EXPECT_EQ(bed.run("warp.strength"), "\"warp.strength\" is \"-0.15\"");
    EXPECT_EQ(bed.run("r_ui_warp"), "\"r_ui_warp\" is \"-0.15\"");
    EXPECT_EQ(bed.run("get gamma"), "\"gamma\" is \"0.9\"");
    EXPECT_EQ(bed.run("r_ui_warp 0.25; warp.strength"), "\"warp.strength\" is \"0.25\"");
    const Handle warp = *bed.composer.find("warp");
    EXPECT_EQ(std::bit_cast<float>(bed.composer.words(warp)[0]), 0.25f) << "one store";
    test::Warp later{.strength = -0.5f};
    ASSERT_TRUE(bed.composer.set(warp, later));
    EXPECT_EQ(bed.console->get("r_ui_warp"), "-0.5");
    EXPECT_EQ(bed.console->number("r_ui_warp"), -0.5);
    EXPECT_EQ(bed.console->get("nothing"), std::nullopt);
    EXPECT_EQ(bed.console->number("nothing"), std::nullopt);
}

TEST(Console, ExplainsItselfAndHasWordsToComplete) {
    ConsoleBed bed;
    EXPECT_NE(bed.run("help").find("exec FILE"), std::string::npos);
    EXPECT_NE(bed.run("help exec").find("Runs a file"), std::string::npos);
    const std::string told = bed.run("help r_ui_warp");
    EXPECT_TRUE(told.starts_with("r_ui_warp: ")) << told;
    EXPECT_NE(told.find("now -0.15"), std::string::npos) << told;
    EXPECT_NE(bed.run("help nothing").find("nothing"), std::string::npos);
    const std::vector<std::string> words = bed.console->words("r");
    EXPECT_TRUE(std::ranges::is_sorted(words));
    for (const char* const word : {"r_ui_warp", "reset", "resetall"}) EXPECT_EQ(std::ranges::count(words, word), 1);
    EXPECT_EQ(bed.console->words("help"), std::vector<std::string>{"help"});
}

TEST(Console, OtherNamesAreThoseOfTheFirstEntryThatHasThem) {
    ConsoleBed bed;
    bed.composer.add(test::Warp{.strength = 0.75f});
    EXPECT_EQ(bed.run("warp#2.strength"), "\"warp#2.strength\" is \"0.75\"");
    EXPECT_EQ(bed.run("r_ui_warp 0.5; warp#2.strength; warp.strength"),
              "\"warp#2.strength\" is \"0.75\"\n\"warp.strength\" is \"0.5\"");
    ASSERT_TRUE(bed.composer.remove(*bed.composer.find("warp")));
    EXPECT_EQ(bed.run("r_ui_warp"), "\"r_ui_warp\" is \"0.75\"");
}

TEST(Console, ValuesArePrintedAsTheReferenceDoes) {
    ConsoleBed bed;
    const auto printed = [&](const std::string& name, const std::string& value) {
        bed.run(name + " \"" + value + "\"");
        return bed.console->get(name).value_or("?");
    };
    EXPECT_EQ(printed("contrast", "1"), "1");
    EXPECT_EQ(printed("contrast", "1.50000"), "1.5");
    EXPECT_EQ(printed("contrast", "+1.5"), "1.5");
    EXPECT_EQ(printed("r_ui_warp", "-0.0"), "0");
    EXPECT_EQ(printed("r_ui_warp", "0.1"), "0.1");
    EXPECT_EQ(printed("r_ui_warp", "1e-7"), "1e-07") << "six decimals would say 0";
    EXPECT_EQ(printed("sample.count", "12"), "12");
    EXPECT_EQ(printed("sample.is_on", "on"), "1");
    EXPECT_EQ(printed("sample.is_on", "0"), "0");
    EXPECT_EQ(printed("sample.shape", "star"), "star");
    EXPECT_EQ(printed("sample.offset", "0.5,-0.25"), "0.5,-0.25");
    EXPECT_EQ(printed("sample.curve", "0:0,0.5:1"), "0:0,0.5:1");
    bed.run("sample.color 1 0.5 0");
    EXPECT_EQ(bed.console->get("sample.color"), "1,0.5,0") << "as words";
}

TEST(Console, OutOfRangeIsSetToTheBoundAndSaid) {
    ConsoleBed bed;
    EXPECT_EQ(bed.run("contrast 3"), "contrast = 3: allowed is [1, 2], set to 2");
    EXPECT_EQ(bed.severities.front(), Severity::Warning);
    EXPECT_EQ(bed.run("contrast"), "\"contrast\" is \"2\"");
    EXPECT_EQ(bed.run("r_ui_warp -1e300"), "r_ui_warp = -1e300: allowed is [-1, 1], set to -1");
    EXPECT_EQ(bed.run("sample.count 0"), "sample.count = 0: allowed is [1, 64], set to 1");
    EXPECT_EQ(bed.run("sample.offset 0.5 7"), "sample.offset = 0.5,7: allowed is [-1, 1], set to 0.5,1");
    EXPECT_EQ(bed.run("contrast 2"), "") << "the bound itself";
}

TEST(Console, WhatIsNoValueIsRefusedAndChangesNothing) {
    ConsoleBed bed;
    for (const char* const line : {"contrast much",
                                   "contrast nan",
                                   "contrast inf",
                                   "contrast 1 2",
                                   "sample.count 2.5",
                                   "sample.shape oval",
                                   "sample.is_on maybe",
                                   "sample.offset 1",
                                   "sample.offset 1,2,3",
                                   "sample.curve 1:1,0:0",
                                   "sample.table 3",
                                   "contrast \"\"",
                                   "inc sample.shape",
                                   "inc contrast x",
                                   "toggle sample.shape",
                                   "cycle contrast",
                                   "toggle",
                                   "cycle",
                                   "inc",
                                   "reset",
                                   "set contrast",
                                   "get",
                                   "exec",
                                   "resetall now",
                                   "reset contrast 2"}) {
        EXPECT_EQ(bed.console->execute(line), 1u) << line;
        EXPECT_EQ(bed.severities.back(), Severity::Error) << line;
    }
    EXPECT_EQ(bed.console->get("contrast"), "1.4");
    EXPECT_EQ(bed.console->get("sample.count"), "4");
    EXPECT_EQ(bed.console->get("sample.shape"), "round");
    EXPECT_EQ(bed.run("sample.shape oval"), "sample.shape = \"oval\": allowed is round, square or star");
    EXPECT_EQ(bed.run("toggle"), "toggle with 0 words: allowed is toggle NAME [VALUE [OTHER]]");
}

TEST(Console, UnknownNamesSayTheNearest) {
    ConsoleBed bed;
    EXPECT_EQ(bed.run("r_ui_wrap 1"), "'r_ui_wrap': no such command or variable, did you mean 'r_ui_warp'?");
    EXPECT_EQ(bed.run("togle gamma"), "'togle': no such command or variable, did you mean 'toggle'?");
    EXPECT_EQ(bed.run("set echo.scael 1"), "'echo.scael': no such variable, did you mean 'echo.scale'?");
    EXPECT_EQ(bed.run("reset \"x\x1b[2J\""), "'x\\x1B[2J': no such variable");
}

TEST(Console, NamesOfEntriesArePrintedFitForATerminal) {
    ConsoleBed bed;
    bed.composer.add(test::Warp{}, {.name = "a\x1b[2J"});
    for (const char* const line :
         {"\"a\x1b[2J.strength\"", "cvarlist a", "\"a\x1b[2J.strength\" 7", "\"a\x1b[2J.strength\" x",
          "\"a\x1b[2J.strength\" 1 2", "inc \"a\x1b[2J.strength\" x"})
        for (const char letter : bed.run(line)) EXPECT_TRUE(letter >= ' ' || letter == '\n') << line;
}

TEST(Console, ToggleCycleAndInc) {
    ConsoleBed bed;
    const auto after = [&](const std::string& commands, const std::string& name) {
        EXPECT_EQ(bed.run(commands), "");
        return bed.console->get(name).value_or("?");
    };
    EXPECT_EQ(after("toggle sample.is_on", "sample.is_on"), "1");
    EXPECT_EQ(after("toggle sample.is_on", "sample.is_on"), "0");
    EXPECT_EQ(after("toggle r_ui_echo", "r_ui_echo"), "0") << "what is not 0 is on";
    EXPECT_EQ(after("toggle r_ui_echo", "r_ui_echo"), "1");
    EXPECT_EQ(after("toggle r_ui_echo 0.5", "r_ui_echo"), "0.5");
    EXPECT_EQ(after("toggle r_ui_echo 0.5", "r_ui_echo"), "0.1") << "its default is the other value";
    EXPECT_EQ(after("toggle r_ui_echo 0.5 2", "r_ui_echo"), "0.5");
    EXPECT_EQ(after("toggle r_ui_echo 0.50 2", "r_ui_echo"), "2");
    EXPECT_EQ(after("cycle gamma 0.7 0.8 0.9", "gamma"), "0.7") << "from the last to the first";
    EXPECT_EQ(after("cycle gamma 0.7 0.8 0.9", "gamma"), "0.8");
    EXPECT_EQ(after("gamma 1; cycle gamma 0.7 0.8", "gamma"), "0.7") << "from elsewhere to the first";
    EXPECT_EQ(after("cycle sample.shape", "sample.shape"), "square") << "all choices";
    EXPECT_EQ(after("cycle sample.shape star round", "sample.shape"), "star");
    EXPECT_EQ(after("inc sample.count", "sample.count"), "5");
    EXPECT_EQ(after("inc sample.count -3", "sample.count"), "2");
    EXPECT_EQ(after("r_ui_warp 0.1; inc r_ui_warp 0.2", "r_ui_warp"), "0.3");
    EXPECT_EQ(bed.run("inc sample.count 100"), "sample.count = 102: allowed is [1, 64], set to 64");
}

TEST(Console, ResetGoesBackToWhatTheLookGave) {
    ConsoleBed bed;
    bed.run("gamma 2; contrast 2; r_ui_warp 1; sample.color 0 0 0; sample.curve 0:0,1:1; sample.count 9");
    EXPECT_EQ(bed.run("reset r_ui_warp; r_ui_warp"), "\"r_ui_warp\" is \"-0.15\"");
    EXPECT_EQ(bed.run("resetcfg"), "");
    EXPECT_EQ(bed.console->get("gamma"), "0.9");
    EXPECT_EQ(bed.console->get("contrast"), "1.4");
    EXPECT_EQ(bed.console->get("sample.count"), "9") << "is not archived";
    EXPECT_EQ(bed.run("resetall"), "");
    EXPECT_EQ(bed.console->get("sample.count"), "4");
    EXPECT_EQ(bed.console->get("sample.color"), "1,1,1");
    EXPECT_EQ(bed.console->get("sample.curve"), "");

    bed.run("gamma 2");
    bed.console->take_defaults();
    EXPECT_EQ(bed.run("gamma 1; reset gamma; gamma"), "\"gamma\" is \"2\"");
    bed.composer.add(test::Warp{.strength = 0.75f});
    EXPECT_EQ(bed.run("reset warp#2.strength; warp#2.strength"), "\"warp#2.strength\" is \"0\"")
        << "an entry of later has its effect's";
}

TEST(Console, TheListHasBothNamesAndMarksWhatIsArchived) {
    ConsoleBed bed;
    EXPECT_EQ(bed.run("cvarlist r_ui_"),
              "  r_ui_chromatic \"0.005\"\n  r_ui_echo \"0.1\"\n  r_ui_echo_scale \"1.01\"\n  r_ui_warp \"-0.15\"\n"
              "4 variables beginning with \"r_ui_\"");
    EXPECT_EQ(bed.run("cvarlist tone."),
              "* tone.contrast \"1.4\"\n* tone.gamma \"0.9\"\n"
              "2 variables beginning with \"tone.\"");
    EXPECT_TRUE(bed.run("cvarlist").ends_with("19 variables"));
    EXPECT_EQ(bed.console->names("r_ui_e"), (std::vector<std::string>{"r_ui_echo", "r_ui_echo_scale"}));
}

TEST(Console, ReadOnlyVariablesRefuse) {
    ConsoleBed bed;
    EXPECT_TRUE(bed.console->lock("gamma"));
    EXPECT_FALSE(bed.console->lock("nothing"));
    for (const char* const line :
         {"gamma 1", "tone.gamma 1", "toggle gamma", "inc gamma", "reset gamma", "seta gamma 1"})
        EXPECT_TRUE(bed.run(line).ends_with("gamma is read-only")) << line;
    EXPECT_FALSE(bed.console->set_override("gamma", "someone", "1"));
    EXPECT_EQ(bed.run("sample.table 0"), "sample.table is read-only") << "a file has no text";
    EXPECT_EQ(bed.run("contrast 1.5; resetall; contrast"), "\"contrast\" is \"1.4\"") << "goes past what is locked";
    EXPECT_EQ(bed.console->get("gamma"), "0.9");
    EXPECT_TRUE(bed.console->lock("gamma", false));
    EXPECT_EQ(bed.run("gamma 1; gamma"), "\"gamma\" is \"1\"");
}

TEST(Console, AnOverrideLeavesTheBaseAlone) {
    ConsoleBed bed;
    const auto set = bed.console->set_override("r_ui_warp", "a pulse", "5");
    ASSERT_TRUE(set);
    EXPECT_EQ(*set, "r_ui_warp = 5: allowed is [-1, 1], set to 1");
    const Handle warp = *bed.composer.find("warp");
    EXPECT_EQ(std::bit_cast<float>(bed.composer.current(warp)[0]), 1.0f);
    EXPECT_EQ(bed.run("r_ui_warp"), "\"r_ui_warp\" is \"-0.15\"");
    bed.composer.drop_overrides("a pulse");
    EXPECT_EQ(std::bit_cast<float>(bed.composer.current(warp)[0]), -0.15f);
}

struct Known {
    const char *name, *effect, *member, *fresh, *value;
    bool is_archived;
};
// The game's names, what they are here before anybody sets them, which is neutral, and the game's own defaults.
constexpr std::array known{Known{"r_ui_warp", "ui_warp", "strength", "0", "-0.1", false},
                           Known{"r_ui_chromatic", "ui_chroma", "strength", "0", "0.003", false},
                           Known{"r_ui_echo", "ui_echo", "strength", "0", "0.1", false},
                           Known{"r_ui_echo_scale", "ui_echo", "size", "1", "1.01", false},
                           Known{"r_ui_additive", "ui_composite", "additive", "0", "0.2", false},
                           Known{"gamma", "contrast_gamma", "gamma", "1", "0.9", true},
                           Known{"contrast", "contrast_gamma", "contrast", "1", "1.4", true},
                           Known{"scr_sbaralpha", "ui_composite", "ui_opacity", "1", "0.75", true}};

TEST(ConsoleNames, OfTheReferenceAreParametersOfTheInterfacesEffects) {
    const Folder folder;
    Composer composer(Device::assumed());
    for (const EffectInfo* const effect : all_effects()) composer.add(*effect, nullptr);
    std::vector<std::string> printed;
    Console console(composer, {.print = [&](Severity, std::string_view line) { printed.emplace_back(line); }});
    for (const Known& one : known) {
        SCOPED_TRACE(one.name);
        if (find_effect(one.effect) == nullptr) continue;
        EXPECT_EQ(console.get(one.name), one.fresh) << "read before anything is set";
        EXPECT_EQ(console.execute(std::string(one.name) + " " + one.value), 0u);
        EXPECT_EQ(console.get(std::string(one.effect) + "." + one.member), one.value);
        const auto is_written = [&] {
            EXPECT_TRUE(console.write_config(folder.path / "out.cfg"));
            return folder.read("out.cfg").find("\"" + std::string(one.name) + "\"") != std::string::npos;
        };
        EXPECT_EQ(is_written(), one.is_archived);
        EXPECT_EQ(console.execute("reset " + std::string(one.name)), 0u);
        EXPECT_EQ(console.get(one.name), one.fresh);
        EXPECT_FALSE(is_written());
    }
    EXPECT_TRUE(printed.empty()) << printed.front();
}

TEST(ConsoleNames, ThoseOfLooksAndFlagsAreKnown) {
    if (find_effect("vignette") == nullptr) GTEST_SKIP();
    Composer composer(Device::assumed());
    composer.add(*find_effect("vignette"), nullptr);
    Console console(composer);
    EXPECT_EQ(console.execute("vignette_intensity 0.5"), 0U);
    EXPECT_EQ(console.get("vignette.intensity"), "0.5");
    EXPECT_EQ(console.execute("--vignette-intensity 0.25"), 0U);
    EXPECT_EQ(console.get("vignette.intensity"), "0.25");
    EXPECT_EQ(console.execute("vignette_intensify 0.5"), 1U);
}

// A variable is one value, and a size in % is two.
TEST(ConsoleNames, SizesArePixels) {
    if (find_effect("gaussian_blur") == nullptr) GTEST_SKIP();
    Composer composer(Device::assumed());
    composer.add(*find_effect("gaussian_blur"), nullptr);
    std::vector<std::string> printed;
    Console console(composer, {.print = [&](Severity, std::string_view line) { printed.emplace_back(line); }});
    console.execute("gaussian_blur.radius 2%");
    ASSERT_EQ(printed.size(), 1U);
    EXPECT_EQ(printed[0], "gaussian_blur.radius = 2%: allowed here is [0, 64] px without %");
    EXPECT_EQ(console.get("gaussian_blur.radius"), "4");
}

TEST(ConsoleNames, NoNameIsTwoThings) {
    std::set<std::string_view> seen{"get",   "set",      "seta",     "toggle",   "cycle", "inc",
                                    "reset", "resetall", "resetcfg", "cvarlist", "exec"};
    for (const EffectInfo* const effect : all_effects()) {
        EXPECT_EQ(effect->name.find('.'), std::string_view::npos);
        for (const ParamInfo& row : effect->parameters.rows)
            EXPECT_TRUE(row.also.empty() || seen.insert(row.also).second) << row.also;
    }
}

TEST(ConsoleConfig, HoldsWhatIsArchivedAndReadsBack) {
    const Folder folder;
    const fs::path path = folder.path / "user.cfg";
    {
        ConsoleBed bed;
        bed.run("gamma 0.7; r_ui_warp 0.5; seta sample.color 0.1 0.2 0.3; seta r_ui_echo 0.123456789");
        ASSERT_TRUE(bed.console->write_config(path));
    }
    EXPECT_EQ(folder.read("user.cfg"),
              "// Written by the program; variables that are archived.\n"
              "\"gamma\" \"0.7\"\nseta \"r_ui_echo\" \"0.12345679\"\nseta \"sample.color\" "
              "\"0.1,0.2,0.3\"\n");
    ConsoleBed bed;
    ASSERT_TRUE(bed.console->read_config(path));
    EXPECT_TRUE(bed.printed.empty());
    EXPECT_EQ(bed.console->get("gamma"), "0.7");
    EXPECT_EQ(bed.console->get("r_ui_warp"), "-0.15") << "is not archived";
    EXPECT_EQ(bed.console->get("sample.color"), "0.1,0.2,0.3");
    const std::string before = folder.read("user.cfg");
    ASSERT_TRUE(bed.console->write_config(path));
    EXPECT_EQ(folder.read("user.cfg"), before) << "what was asked for once stays archived";
}

TEST(ConsoleConfig, LeavesOutWhatIsLocked) {
    const Folder folder;
    ConsoleBed bed;
    bed.run("seta r_ui_echo 0.25");
    for (const char* const name : {"gamma", "r_ui_echo"}) ASSERT_TRUE(bed.console->lock(name));
    ASSERT_TRUE(bed.console->write_config(folder.path / "user.cfg"));
    EXPECT_EQ(folder.read("user.cfg"), "// Written by the program; variables that are archived.\n");
}

TEST(ConsoleConfig, KeepsWhatAnotherStackHad) {
    const Folder folder;
    folder.write("user.cfg", "\"scr_sbaralpha\" \"0.5\"\nseta \"bloom#2.intensity\" \"0.25\"\ngamma 2\n");
    const fs::path path = folder.path / "user.cfg";
    ConsoleBed bed;
    ASSERT_TRUE(bed.console->read_config(path));
    EXPECT_TRUE(bed.printed.empty());
    ASSERT_TRUE(bed.console->write_config(path));
    EXPECT_EQ(folder.read("user.cfg"),
              "// Written by the program; variables that are archived.\n"
              "seta \"bloom#2.intensity\" \"0.25\"\n\"gamma\" \"2\"\n\"scr_sbaralpha\" \"0.5\"\n");
    EXPECT_EQ(bed.run("scr_sbaralpha 1"), "'scr_sbaralpha': no such command or variable") << "in a file alone";
}

TEST(ConsoleConfig, IsWrittenWholeOrNotAtAll) {
    const Folder folder;
    ConsoleBed bed;
    EXPECT_TRUE(bed.console->read_config(folder.path / "none.cfg")) << "the first start";
    const auto lost = bed.console->write_config(folder.path / "missing" / "user.cfg");
    ASSERT_FALSE(lost);
    EXPECT_NE(lost.error().text.find("missing/user.cfg"), std::string::npos);
    fs::create_directory(folder.path / "folder.cfg");
    EXPECT_FALSE(bed.console->write_config(folder.path / "folder.cfg"));
    EXPECT_FALSE(bed.console->read_config(folder.path / "folder.cfg"));
    ASSERT_TRUE(bed.console->write_config(folder.path / "user.cfg"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), {}), 2) << "nothing temporary is left";
}

TEST(ConsoleConfig, FaultsNameFileAndLine) {
    const Folder folder;
    folder.write("user.cfg", "gamma 1\n// a comment\ncontrast much; gamma 99\n");
    ConsoleBed bed(folder.path);
    const std::string path = (folder.path / "user.cfg").string();
    EXPECT_EQ(bed.run("exec user.cfg"), path +
                                            ":3: contrast: 'much' is not a number, allowed is [1, 2]\n"
                                            "gamma = 99: allowed is [0.25, 4], set to 4");
}

TEST(ConsoleExec, ReadsFilesOfItsFolderAlone) {
    const Folder folder;
    fs::create_directory(folder.path / "inner");
    folder.write("inner/a.cfg", "gamma 2; exec b.cfg");
    folder.write("b.cfg", "contrast 2");
    ConsoleBed bed(folder.path / "inner");
    EXPECT_EQ(bed.console->execute("exec a.cfg"), 1u) << "b.cfg is not in its folder";
    EXPECT_EQ(bed.console->get("gamma"), "2");
    EXPECT_EQ(bed.console->get("contrast"), "1.4");
    for (const std::string& name :
         {std::string("../b.cfg"), (folder.path / "b.cfg").string(), std::string("x/../../b.cfg"), std::string("..")})
        EXPECT_NE(bed.run("exec \"" + name + "\"").find("of the console's folder"), std::string::npos) << name;
    // Links are followed in it, and not out of it: an error would print a line of what is there.
    fs::create_symlink("a.cfg", folder.path / "inner" / "same.cfg");
    EXPECT_EQ(bed.console->execute("exec same.cfg"), 1u) << "b.cfg, as above";
    fs::create_symlink(folder.path / "b.cfg", folder.path / "inner" / "out.cfg");
    fs::create_directory_symlink(folder.path, folder.path / "inner" / "up");
    for (const std::string name : {"out.cfg", "up/b.cfg"}) {
        EXPECT_EQ(bed.run("exec " + name), "exec " + name + ": leads out of the console's folder");
        EXPECT_EQ(bed.console->get("contrast"), "1.4");
    }
    ASSERT_EQ(::mkfifo((folder.path / "inner" / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(bed.run("exec pipe"), (folder.path / "inner" / "pipe: is a pipe, a regular file is needed").string())
        << "a pipe would be waited for";
    EXPECT_EQ(bed.console->execute("exec \"\""), 1u);
    EXPECT_EQ(bed.console->execute("exec a.cfg", {.allows_files = false}), 1u);
    ConsoleBed without;
    EXPECT_EQ(without.run("exec a.cfg"), "exec a.cfg: files are not read from here");
}

TEST(ConsoleExec, HostileFilesEnd) {
    const Folder folder;
    std::string bomb;
    for (int i = 0; i < 2000; ++i) bomb += "exec bomb.cfg\n";
    folder.write("bomb.cfg", bomb);
    ConsoleBed bed(folder.path);
    EXPECT_GT(bed.console->execute("exec bomb.cfg"), 0u);
    EXPECT_LE(bed.printed.size(), 70u);
    EXPECT_NE(bed.printed.front().find("at most 8 deep"), std::string::npos);
    EXPECT_NE(bed.printed.back().find("10000"), std::string::npos);

    std::string lists, typos;
    for (int i = 0; i < 9000; ++i) lists += "cvarlist\nresetall\n";
    folder.write("lists.cfg", lists);
    bed.run("exec lists.cfg");
    EXPECT_LE(bed.printed.size(), 2010u);
    for (int i = 0; i < 9000; ++i) typos += "nothing_like_it 1\n";
    folder.write("typos.cfg", typos);
    EXPECT_EQ(bed.console->execute("exec typos.cfg"), 9000u);
    EXPECT_EQ(bed.printed.back(), "and 8936 more commands that were refused");

    folder.write("long.cfg", std::string(2 << 20, ' '));
    EXPECT_NE(bed.run("exec long.cfg").find("at most 1048576 are read"), std::string::npos);
    folder.write("word.cfg", "gamma \"" + std::string(1 << 19, '1') + "\"\n" + std::string(1 << 18, 'a'));
    bed.run("exec word.cfg");
    for (const std::string& line : bed.printed) EXPECT_LT(line.size(), 600u);
    std::string words = "gamma";
    for (int i = 0; i < 100000; ++i) words += " 1";
    EXPECT_EQ(bed.console->execute(words), 1u);
    ASSERT_TRUE(bed.console->read_config(folder.path / "typos.cfg"));
    ASSERT_TRUE(bed.console->write_config(folder.path / "out.cfg"));
}

}  // namespace
}  // namespace darkroom
