// SPDX-License-Identifier: MIT
// Sequences through the built program: the same files whatever the threads and the pieces, and what becomes of frames
// that are there already, missing or damaged.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "programs/darkroom/run/json.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using test::content;
using test::Outcome;

class CliSequence : public test::CliFixture {
  protected:
    static constexpr int count = 7;

    void make_files() override {
        for (int number = 1; number <= count; ++number) make_frame(number, true);
    }
    void make_frame(int number, bool has_depth) const {
        FrameFile frame;
        frame.color = Picture(48, 32);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] =
                i % 4 == 3 ? 1.0f : static_cast<float>((i * 37 + static_cast<std::size_t>(number)) % 101) / 40.0f;
        if (has_depth) {
            frame.depth = Plane<1>(48, 32);
            std::ranges::fill(frame.depth->values, 5.0f);
        }
        ASSERT_TRUE(write_frame(path(in(number)), frame));
    }
    static void put(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }
    static std::string in(int number) { return fmt::format("f.{:04}.exr", number); }
    static std::string out(const std::string& folder, int number) {
        return fmt::format("{}/f.{:04}.png", folder, number);
    }

    [[nodiscard]] Outcome develop(const std::string& folder, std::vector<std::string> flags = {}) const {
        fs::create_directories(path(folder));
        flags.insert(flags.begin(),
                     {"develop", path("f.%04d.exr"), "-o", path(folder) + "/", "--dither-enabled", "on"});
        return run(flags);
    }
    [[nodiscard]] std::vector<std::string> pictures(const std::string& folder) const {
        std::vector<std::string> out_files;
        for (int number = 1; number <= count; ++number) out_files.push_back(content(path(out(folder, number))));
        return out_files;
    }
};

TEST_F(CliSequence, FilesAreTheSameWhateverTheJobs) {
    for (const char* jobs : {"1", "2", "5"}) {
        const Outcome outcome = develop(jobs, {"--jobs", jobs});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(std::ranges::count(outcome.told, '\n'), count);
        EXPECT_EQ(outcome.out, "") << "what was done is no answer";
    }
    const std::vector<std::string> one = pictures("1");
    EXPECT_NE(one[0], one[1]);
    EXPECT_EQ(pictures("2"), one);
    EXPECT_EQ(pictures("5"), one);
}

TEST_F(CliSequence, PiecesAreTheWhole) {
    ASSERT_EQ(develop("whole").code, 0);
    ASSERT_EQ(develop("a", {"--frames", "3-5"}).code, 0);
    EXPECT_FALSE(fs::exists(path(out("a", 2))));
    EXPECT_FALSE(fs::exists(path(out("a", 6))));
    for (int number = 3; number <= 5; ++number)
        EXPECT_EQ(content(path(out("a", number))), content(path(out("whole", number)))) << number;
    const Outcome none = develop("a", {"--frames", "30-50"});
    EXPECT_EQ(none.code, 1);
    EXPECT_EQ(none.err, "darkroom: --frames 30-50: none of the 7 inputs has such a number\n");
}

TEST_F(CliSequence, NamesOfPicturesThatAreNotAskedForAreNotTried) {
    fs::create_directories(path(out("g", 2)));
    EXPECT_NE(develop("g").code, 0) << "a folder is in the way";
    EXPECT_EQ(develop("g", {"--frames", "3-5"}).code, 0);
}

TEST_F(CliSequence, WhatIsThereStaysWhereAsked) {
    fs::create_directories(path("b"));
    put(path(out("b", 3)), "there");
    put(path(out("b", 4)), "");
    const Outcome some = develop("b", {"--skip-existing"});
    ASSERT_EQ(some.code, 0);
    EXPECT_TRUE(some.told.starts_with("1 of 7 pictures are there already\n")) << some.told;
    EXPECT_EQ(content(path(out("b", 3))), "there");
    EXPECT_GT(content(path(out("b", 4))).size(), 100u) << "an empty file is no picture";
    const Outcome again = develop("b", {"--skip-existing"});
    EXPECT_EQ(again.code, 0);
    EXPECT_EQ(again.told, "7 of 7 pictures are there already\n");
    ASSERT_EQ(develop("b").code, 0);
    EXPECT_NE(content(path(out("b", 3))), "there");
}

TEST_F(CliSequence, EachEyeHasItsPicture) {
    for (const std::string eye : {"left", "right"})
        for (const int number : {1, 2})
            fs::copy_file(path(in(number)), path(fmt::format("eye_{}.{:04}.exr", eye, number)));
    const Outcome both = run_lines("darkroom develop 'eye_%V.####.exr' --eye both -o 'eye_%v.####.png'");
    EXPECT_EQ(both.code, 0) << both.err;
    for (const char* const made : {"eye_l.0001.png", "eye_l.0002.png", "eye_r.0001.png", "eye_r.0002.png"})
        EXPECT_TRUE(fs::exists(path(made))) << made;
    EXPECT_EQ(run_lines("darkroom develop f.0001.exr --eye both -o a.png").err,
              "darkroom: -o a.png: two eyes need a name with %V or %v\n");
    const Outcome none = run_lines("darkroom develop f.0001.exr --eye left -o a.png");
    EXPECT_EQ(none.code, 1);
    EXPECT_EQ(none.err, "darkroom: f.0001.exr: has no view \"left\"; it has one picture alone\n");
    const Outcome scaled =
        run_lines("darkroom develop f.0001.exr --depth-scale 0.01 --depth-inverse --overscan -o a.png");
    EXPECT_EQ(scaled.code, 0) << scaled.err;
}

TEST_F(CliSequence, WhoReadsTheFirstLineAloneDoesNotEndTheWork) {
    fs::create_directories(path("h"));
    const Outcome outcome = run_lines("darkroom develop f.%04d.exr -o h/ --jobs 1 2>&1 | head -n 1");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (int number = 1; number <= count; ++number) EXPECT_TRUE(fs::exists(path(out("h", number)))) << number;
}

TEST_F(CliSequence, WhatCannotBeWrittenToStandardOutputIsTold) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    // Closed, the place goes to the first file that is opened, which would have the lines.
    const std::vector<std::pair<std::string, std::string>> ends{{" > /dev/full", "No space left on device"},
                                                                {" >&-", "Bad file descriptor"}};
    for (const std::string command :
         {"info f.0001.exr", "effects", "plan", "devices", "effects bloom --json", "--help", "info f.0001.exr --json",
          "compare f.0001.exr f.0001.exr", "histogram f.0001.exr", "--version"})
        for (const auto& [end, why] : ends) {
            const Outcome outcome = run_lines("darkroom " + command + end);
            EXPECT_EQ(outcome.code, 2) << command << end;
            // The parser's own lines leave no reason.
            const std::string wanted = command == "--version" ? "cannot write" : why;
            EXPECT_NE(outcome.err.find(wanted), std::string::npos) << command << end << ": " << outcome.err;
            EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << command << end << ": " << outcome.err;
        }
    EXPECT_EQ(run_lines("darkroom develop f.0001.exr -o c.png <&- >&- 2>&-").code, 0);
    EXPECT_EQ(content(path("c.png")).substr(1, 3), "PNG");
}

TEST_F(CliSequence, AFailureStopsTheFramesAfterIt) {
    put(path(in(4)), "no picture");
    const Outcome outcome = develop("c", {"--jobs", "3"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("f.0004.exr: is not a picture of a known format"), std::string::npos) << outcome.err;
    for (int number = 1; number <= 3; ++number) EXPECT_TRUE(fs::exists(path(out("c", number)))) << number;
    EXPECT_FALSE(fs::exists(path(out("c", 4))));
}

TEST_F(CliSequence, KeepsGoingAndListsAllFailures) {
    put(path(in(2)), "no picture");
    put(path(in(6)), "");
    const Outcome outcome = develop("d", {"--keep-going"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("f.0002.exr: is not a picture of a known format"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("f.0006.exr: is empty"), std::string::npos) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with("darkroom: 2 of 7 frames failed\n")) << outcome.err;
    for (int number = 1; number <= count; ++number)
        EXPECT_EQ(fs::exists(path(out("d", number))), number != 2 && number != 6) << number;
}

TEST_F(CliSequence, SignsAreDigits) {
    const Outcome outcome = run({"develop", path("f.####.exr[2-3]"), "-o", path("g.@@@.png")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(path("g.002.png")));
    EXPECT_TRUE(fs::exists(path("g.003.png")));
    EXPECT_EQ(run({"develop", path(in(1)), "-o", path("a#1.png")}).code, 0);
    EXPECT_TRUE(fs::exists(path("a#1.png"))) << "one sign is a name";
}

// Versions, shots and takes have numbers, too.
TEST_F(CliSequence, ThePatternSaysWhichNumberIsTheFrames) {
    for (int number = 1; number <= 3; ++number)
        fs::copy_file(path(in(number)), path(fmt::format("shot_{:04}_v2.exr", number + 9)));
    ASSERT_EQ(run({"develop", path("shot_####_v2.exr"), "-o", path("out_####.png")}).code, 0);
    ASSERT_EQ(run({"develop", path("shot_$F4_v2.exr"), "--frames", "10,12", "-o", path("some_$F4.png")}).code, 0);
    for (int number = 10; number <= 12; ++number) {
        const std::string out_file = content(path(fmt::format("out_{:04}.png", number)));
        EXPECT_FALSE(out_file.empty()) << number;
        const std::string some = path(fmt::format("some_{:04}.png", number));
        EXPECT_EQ(fs::exists(some), number != 11);
        if (number == 11) continue;
        EXPECT_EQ(content(some), out_file);
    }
    const Outcome none = run({"develop", path("shot_####_v2.exr"), "--frames", "1-3", "-o", path("none_####.png")});
    EXPECT_EQ(none.code, 1);
    EXPECT_EQ(none.err, "darkroom: --frames 1-3: none of the 3 inputs has such a number\n");
}

// Of several sequences a number says nothing: pictures are counted as the inputs come.
TEST_F(CliSequence, InputsThatShareANumberAreCounted) {
    fs::copy_file(path(in(1)), path("a.0001.exr"));
    fs::copy_file(path(in(2)), path("b.0001.exr"));
    const Outcome outcome = run_lines("darkroom develop a.0001.exr b.0001.exr -o out.####.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_EQ(run_lines("darkroom develop a.0001.exr -o a.png && darkroom develop b.0001.exr -o b.png").code, 0);
    EXPECT_EQ(picture("out.0001.png").pixels, picture("a.png").pixels);
    EXPECT_EQ(picture("out.0002.png").pixels, picture("b.png").pixels);
    EXPECT_NE(picture("a.png").pixels, picture("b.png").pixels);
}

TEST_F(CliSequence, FramesBeforeTheFirstOneAndEverySecondOne) {
    for (int number = 1; number <= 4; ++number)
        fs::copy_file(path(in(number)), path(fmt::format("n.{:04}.exr", number - 3)));
    ASSERT_EQ(run({"develop", path("n.%04d.exr"), "--frames", "-2-1x2", "--fps", "24", "-o", path("m.%04d.png")}).code,
              0);
    EXPECT_TRUE(fs::exists(path("m.-002.png")));
    EXPECT_FALSE(fs::exists(path("m.-001.png")));
    EXPECT_TRUE(fs::exists(path("m.0000.png")));
    EXPECT_FALSE(fs::exists(path("m.0001.png")));
    for (const char* const wrong : {"1-", "2-1", "1-5x0", "1..5"}) {
        const Outcome outcome = run({"develop", path("n.%04d.exr"), "--frames", wrong, "-o", path("m.%04d.png")});
        EXPECT_EQ(outcome.code, 1);
        EXPECT_TRUE(outcome.err.starts_with(fmt::format("darkroom: --frames {}: ", wrong))) << outcome.err;
    }
}

TEST_F(CliSequence, TellsOnceOfTheViewThatItAssumes) {
    const Outcome outcome = develop("v", {"--fog-density", "0.1"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "darkroom: warning: " + path(in(1)) +
                               ": has depth and no projection: a vertical field of view of 45 degrees is assumed; "
                               "--fov or --camera sets another\n");
    EXPECT_EQ(develop("v").err, "") << "nothing asks for depth";
}

TEST_F(CliSequence, TellsWhereWhatIsLeftOutChanges) {
    make_frame(3, false);
    make_frame(4, false);
    const Outcome outcome = develop("e", {"--fog-density", "0.1", "--fov", "45"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 2) << outcome.err;
    EXPECT_NE(outcome.err.find("f.0003.exr: left out: fog: needs depth"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("f.0005.exr: nothing is left out any more"), std::string::npos) << outcome.err;
}

TEST_F(CliSequence, ProgressIsReadByAnotherProgram) {
    put(path(in(4)), "no picture");
    const Outcome outcome = develop("json", {"--progress", "json", "--keep-going", "--jobs", "1"});
    EXPECT_EQ(outcome.code, 1);
    std::map<std::string, std::vector<app::Json>> events;
    std::istringstream lines(outcome.told);
    for (std::string line; std::getline(lines, line);) {
        const std::optional<app::Json> event = app::Json::parse(line);
        ASSERT_TRUE(event && event->find("event") != nullptr) << line;
        events[event->find("event")->text()].push_back(*event);
    }
    ASSERT_EQ(events["start"].size(), 1u) << outcome.told;
    EXPECT_EQ(events["start"][0].find("total")->whole(), count);
    ASSERT_EQ(events["picture"].size(), static_cast<std::size_t>(count - 1));
    const app::Json& first = events["picture"][0];
    EXPECT_EQ(first.find("done")->whole(), 1);
    EXPECT_EQ(first.find("output")->text(), path(out("json", 1)));
    EXPECT_EQ(first.find("width")->whole(), 48);
    EXPECT_EQ(first.find("height")->whole(), 32);
    ASSERT_EQ(events["failed"].size(), 1u);
    EXPECT_NE(events["failed"][0].find("text")->text().find("0004"), std::string::npos);
    ASSERT_EQ(events["end"].size(), 1u);
    EXPECT_EQ(events["end"][0].find("failed")->whole(), 1);
    EXPECT_FALSE(events["error"].empty());
    EXPECT_EQ(outcome.err, outcome.told) << "nothing but JSON";
    expect_refused({"develop", path(in(1)), "-o", path("x.png"), "--progress", "xml"}, 1, "allowed is text, json");
}

TEST_F(CliSequence, MissingFoldersAreMadeWhereAsked) {
    for (const std::string where : {"new/deep/", "also/{name}.png"}) {
        expect_refused({"develop", path(in(1)), path(in(2)), "-o", path(where)}, 1, "--mkdir makes it");
        const Outcome outcome = run({"develop", path(in(1)), path(in(2)), "--mkdir", "-o", path(where)});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    EXPECT_TRUE(fs::exists(path("new/deep/f.0002.png")) && fs::exists(path("also/f.0002.png")));
    put(path("a.cube"), "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
    const std::vector<std::vector<std::string>> others{
        {"compare", path(in(1)), path(in(1)), "--diff", path("d1/d/diff.png")},
        {"compare", path(in(1)), path(in(1)), "--sheet", path("d2/d/sheet.png")},
        {"lut", "convert", path("a.cube"), "-o", path("d3/d/b.cube")},
        {"lut", "export", "--exposure", "2", "-o", path("d4/d/c.cube")},
        {"bake", path("look.toml"), "--profile", "gpu", "-o", path("d5/d/k.dkb")}};
    put(path("look.toml"), "[[stack]]\neffect = \"exposure\"\n");
    for (std::vector<std::string> words : others) {
        expect_refused(words, 1, "no such folder, nothing can be written there; --mkdir makes it");
        words.emplace_back("--mkdir");
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    for (const char* const made : {"d1/d/diff.png", "d2/d/sheet.png", "d3/d/b.cube", "d4/d/c.cube", "d5/d/k.dkb"})
        EXPECT_TRUE(fs::exists(path(made))) << made;
    put(path("file"), "no folder");
    expect_refused({"develop", path(in(1)), "--mkdir", "-o", path("file/x/y.png")}, 1, "cannot be made");
}

TEST_F(CliSequence, TimingsSayWhatEachStageTook) {
    const Outcome outcome = develop("h", {"--timings", "--jobs", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* line : {"ms  decode a frame, on 2 threads", "ms  upload, GPU and read-back a frame",
                             "ms  encode a frame, on 2 threads", "frames a second", "together, means of all frames"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
}

TEST_F(CliSequence, FramesASecondMakeWhatMovesMove) {
    for (int number = 2; number <= count; ++number)
        fs::copy_file(path(in(1)), path(in(number)), fs::copy_options::overwrite_existing);
    ASSERT_EQ(develop("j", {"--fps", "24", "--dither-moves", "on"}).code, 0);
    EXPECT_NE(content(path(out("j", 1))), content(path(out("j", 2)))) << "the dither moves with time";
    ASSERT_EQ(develop("k", {"--time", "0.5"}).code, 0);
    ASSERT_EQ(develop("l", {"--fps", "2"}).code, 0);
    EXPECT_EQ(content(path(out("k", 1))), content(path(out("l", 1)))) << "frame 1 is at half a second";
    const Outcome both = develop("i", {"--fps", "24", "--time", "1"});
    EXPECT_EQ(both.code, 1);
    EXPECT_EQ(both.err, "darkroom: --time: --fps sets the time of every frame; give one of the two\n");
}

TEST_F(CliSequence, FilesAreCodedAsAsked) {
    const auto size = [&](const std::string& name, std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"develop", path(in(1)), "-o", path(name)});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return fs::file_size(path(name));
    };
    EXPECT_LT(size("a.jpg", {"--quality", "20"}), size("b.jpg", {"--quality", "95"}));
    EXPECT_LT(size("a.png", {"--compression", "9"}), size("b.png", {"--compression", "0"}));
    EXPECT_LT(size("a.exr", {"--compression", "zip"}), size("b.exr", {"--compression", "none"}));
    const auto refused = [&](const std::string& name, std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"develop", path(in(1)), "-o", path(name)});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 1);
        return outcome.err.substr(outcome.err.find(name));
    };
    EXPECT_EQ(refused("c.png", {"--quality", "20"}), "c.png: PNG has no quality; .jpg has\n");
    EXPECT_EQ(refused("c.tif", {"--compression", "piz"}),
              "c.tif: compression piz in TIFF; allowed: none, packbits, lzw, zip\n");
    EXPECT_EQ(refused("c.jpg", {"--compression", "zip"}),
              "c.jpg: compression zip in JPEG; allowed: none can be chosen\n");
}

TEST_F(CliSequence, RenderedFramesAreTheSameWhateverTheJobs) {
    put(path("s.scene.toml"), "[scene]\nname = \"empty\"\n");
    for (const char* jobs : {"1", "3"}) {
        const Outcome outcome =
            run({"render", path("s.scene.toml"), "--size", "32x24", "--frames", "2-5", "--jobs", jobs, "-o",
                 path(std::string("r") + jobs + ".##.png"), "--frame", path(std::string("r") + jobs + ".##.exr")});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    for (const char* number : {"02", "03", "04", "05"})
        for (const char* kind : {"png", "exr"})
            EXPECT_EQ(content(path(fmt::format("r1.{}.{}", number, kind))),
                      content(path(fmt::format("r3.{}.{}", number, kind))))
                << number;
}

}  // namespace
}  // namespace darkroom
