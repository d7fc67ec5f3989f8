// SPDX-License-Identifier: MIT
// Every call for a file fails once, of each command that writes some: what was there before stays or is replaced by the
// whole, nothing lies beside it, and one line says what failed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

/// How many errors a call may have at most (fail_file_calls.cpp).
constexpr std::size_t max_errors = 4;

struct Command {
    const char* name;
    std::vector<std::string> words;
    std::vector<std::string> made;  ///< files, which are there before
};

class FileCalls : public test::CliFixture {
  protected:
    void make_files() override {
        for (int number = 1; number <= 2; ++number) {
            FrameFile frame;
            frame.color = Picture(24, 16);
            for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
                frame.color.pixels[i] =
                    i % 4 == 3 ? 1.0f : static_cast<float>((i * 37 + static_cast<std::size_t>(number)) % 101) / 40.0f;
            ASSERT_TRUE(write_frame(path(fmt::format("f.{:04}.exr", number)), frame));
        }
        write("look.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\nexposure = 0.5\n");
        write("small.scene.toml",
              "format = 1\n[scene]\nname = \"Small\"\n[camera]\nposition = [0, 2, 8]\ntarget = [0, 1, 0]\n"
              "[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 2, 1] }\n");
        fs::create_directory(path("new"));
    }

    [[nodiscard]] std::vector<Command> commands() const {
        const auto in = [&](const char* name) { return path(name); };
        return {
            {"develop", {"develop", in("f.0001.exr"), "--look", in("look.toml"), "-o", in("new/a.png")}, {"a.png"}},
            {"develop to EXR",
             {"develop", in("f.0001.exr"), "--look", in("look.toml"), "-o", in("new/a.exr")},
             {"a.exr"}},
            {"develop a sequence",
             {"develop", in("f.%04d.exr"), "--look", in("look.toml"), "-o", in("new/"), "--jobs", "1"},
             {"f.0001.png", "f.0002.png"}},
            {"bake",
             {"bake", in("look.toml"), "--profile", "gpu", "--size", "24x16", "-o", in("new/k.dkb")},
             {"k.dkb"}},
            {"lut", {"lut", "export", in("look.toml"), "-o", in("new/t.cube")}, {"t.cube"}},
            {"compare", {"compare", in("f.0001.exr"), in("f.0002.exr"), "--html", in("new/page.html")}, {"page.html"}},
            {"new", {"new", "look", in("new/evening"), "--force"}, {"evening.toml"}},
            {"render", {"render", in("small.scene.toml"), "--size", "24x16", "-o", in("new/r.png")}, {"r.png"}},
            {"render a frame",
             {"render", in("small.scene.toml"), "--size", "24x16", "--shadow-resolution", "64", "-o", in("new/r.png"),
              "--frame", in("new/r.exr")},
             {"r.exr", "r.png"}},
        };
    }

    static constexpr std::string_view old = "what was there before\n";

    void put_old(const Command& command) const {
        fs::remove_all(path("new"));
        fs::create_directory(path("new"));
        for (const std::string& file : command.made) write("new/" + file, std::string(old));
    }
    [[nodiscard]] std::map<std::string, std::string> found() const {
        std::map<std::string, std::string> out;
        for (const auto& file : fs::directory_iterator(path("new")))
            out[file.path().filename().string()] = test::content(file.path());
        return out;
    }
    /// Runs it with call `number` failing.
    [[nodiscard]] test::Outcome run_failing(const Command& command, long number, std::size_t error) const {
        ::setenv("LD_PRELOAD", (std::string(test::binary_folder) + "/bin/darkroom_fail_file_calls.so").c_str(), 1);
        ::setenv("DARKROOM_FAIL_FOLDER", path("").c_str(), 1);
        ::setenv("DARKROOM_FAIL_LOG", (path("") + "log").c_str(), 1);
        ::setenv("DARKROOM_FAIL_NUMBER", fmt::format("{}", number).c_str(), 1);
        ::setenv("DARKROOM_FAIL_ERROR", fmt::format("{}", error).c_str(), 1);
        fs::remove(path("log"));
        const test::Outcome out = run(command.words);
        for (const char* const name :
             {"LD_PRELOAD", "DARKROOM_FAIL_FOLDER", "DARKROOM_FAIL_LOG", "DARKROOM_FAIL_NUMBER", "DARKROOM_FAIL_ERROR"})
            ::unsetenv(name);
        return out;
    }

    void expect_whole_or_old(const Command& command, const std::map<std::string, std::string>& whole,
                             const test::Outcome& outcome) const {
        const std::map<std::string, std::string> now = found();
        bool is_all = true;
        for (const auto& [name, bytes] : now) {
            ASSERT_TRUE(whole.contains(name)) << name << " was left behind";
            EXPECT_TRUE(bytes == old || bytes == whole.at(name)) << name << " is neither the old file nor the new one";
            is_all = is_all && bytes == whole.at(name);
        }
        EXPECT_EQ(now.size(), whole.size()) << "a file is lost";
        const auto lines = std::ranges::count(outcome.err, '\n');
        if (outcome.code == 0) {
            EXPECT_TRUE(is_all) << command.name << " says that all went well";
            EXPECT_EQ(lines, 0) << outcome.err;
        } else {
            EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << outcome.code;
            EXPECT_EQ(lines, 1) << outcome.err;
            EXPECT_NE(outcome.err.find(path("")), std::string::npos) << "no file is named: " << outcome.err;
        }
    }

    /// All points, or `most` of each command by seed. Tells how many.
    std::size_t try_all(std::size_t most) {
        std::size_t tried = 0;
        std::mt19937 random(5);
        for (const Command& command : commands()) {
            if (HasFailure()) break;
            SCOPED_TRACE(command.name);
            put_old(command);
            const test::Outcome untouched = run_failing(command, -1, 0);
            EXPECT_EQ(untouched.code, 0) << untouched.err;
            const std::map<std::string, std::string> whole = found();
            EXPECT_EQ(whole.size(), command.made.size());
            const std::string calls = test::content(path("log"));
            EXPECT_GT(calls.size(), 5U);
            std::vector<std::pair<std::size_t, std::size_t>> points;
            for (std::size_t number = 0; number < calls.size(); ++number)
                for (std::size_t error = 0; error < max_errors; ++error) points.emplace_back(number, error);
            std::ranges::shuffle(points, random);
            points.resize(std::min(points.size(), most));
            for (const auto& [number, error] : points) {
                SCOPED_TRACE(fmt::format("call {} ({}) of {}, error {}", number, calls[number], calls, error));
                put_old(command);
                expect_whole_or_old(command, whole, run_failing(command, static_cast<long>(number), error));
                ++tried;
            }
            fmt::print("{}: {} calls, {} points tried\n", command.name, calls.size(), points.size());
        }
        return tried;
    }
};

class CliFailedFileCalls : public FileCalls {};
class SoakFailedFileCalls : public FileCalls {};

TEST_F(CliFailedFileCalls, BySeed) { fmt::print("{} points\n", try_all(2)); }
TEST_F(SoakFailedFileCalls, All) { fmt::print("{} points\n", try_all(~std::size_t{0})); }

}  // namespace
}  // namespace darkroom
