// SPDX-License-Identifier: MIT
// The page of recipes, as it is written: its lines are run in their order, what it says they print is looked for, and
// the steps of its workflow are taken with pictures that are equal and with one that is not.
#include <darkroom/effects.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/picture/write.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;
using test::content;
using test::Outcome;

struct Block {
    std::string kind, text;
};

/// The blocks of code below a head, until the next one.
std::vector<Block> blocks_of(const std::string& head) {
    std::istringstream lines(content(fs::path(test::source_folder) / "docs/recipes.md"));
    std::vector<Block> out;
    bool is_below = false, is_inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) is_below = line == "## " + head;
        if (!is_below) continue;
        if (line.starts_with("```")) {
            if (!is_inside) out.push_back({line.substr(3), ""});
            is_inside = !is_inside;
        } else if (is_inside) {
            out.back().text += line + "\n";
        }
    }
    EXPECT_FALSE(out.empty()) << head;
    return out;
}

class CliRecipes : public test::CliFixture {
  protected:
    void make_files() override {
        const char* const data = std::getenv("DARKROOM_TEST_DATA");
        if (data == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
        for (const char* const name : {"ssao", "bloom", "fog", "motion_blur", "tonemap", "encode", "exposure", "lut"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        const fs::path exr = fs::path(data) / "exr";
        for (const char* const number : {"0020", "0021", "0022", "0023"})
            link(exr / "render_interior" / (std::string("interior.") + number + ".exr"),
                 std::string("blender.") + number + ".exr");
        link(exr / "vray_cornellBox_50ch.0001.exr", "vray.exr");
        link(exr / "photos/Desk.exr", "photo.exr");
        write("film.cube", "LUT_1D_SIZE 2\n0 0 0\n1 0.9 0.8\n");
    }
    void link(const fs::path& from, const std::string& name) const {
        ASSERT_TRUE(fs::exists(from)) << from;
        fs::create_symlink(from, path(name));
    }
    /// Runs what is to be typed, and looks for what is said to be printed in what the lines before it printed.
    void try_all(const std::string& head) const {
        Outcome last;
        for (const auto& [kind, text] : blocks_of(head)) {
            if (kind == "sh") {
                last = run_lines(text);
                EXPECT_EQ(last.code, 0) << text << last.err;
            } else if (kind == "text") {
                EXPECT_NE((last.out + last.told + last.err).find(text), std::string::npos)
                    << text << " is not in " << last.err;
            }
        }
    }
};

TEST_F(CliRecipes, FramesOfBlender) {
    try_all("Frames of Blender");
    EXPECT_TRUE(fs::exists(path("out.0023.png")));
}

TEST_F(CliRecipes, FramesOfVRay) { try_all("Frames of V-Ray"); }

TEST_F(CliRecipes, AMovie) {
    if (run_lines("command -v ffmpeg").code != 0) GTEST_SKIP() << "there is no ffmpeg on this machine";
    try_all("A movie");
    EXPECT_GT(fs::file_size(path("out.mp4")), 1000U);
    EXPECT_GT(fs::file_size(path("out.mkv")), 1000U);
    const Outcome movie = run_lines("ffmpeg -i out.mp4 2>&1 | grep Video: || true");
    EXPECT_NE(movie.out.find("yuv420p(tv, bt709"), std::string::npos) << movie.out;
}

TEST_F(CliRecipes, PicturesThatAreWatchedByCi) {
    try_all("Pictures that are watched by CI");
    std::string steps;
    for (const auto& [kind, text] : blocks_of("Pictures that are watched by CI")) {
        if (kind != "yaml") continue;
        std::istringstream lines(text);
        constexpr std::string_view run = "- run: ";
        for (std::string line; std::getline(lines, line);)
            if (const std::size_t at = line.find(run);
                at != std::string::npos && line.find("darkroom/darkroom ") == std::string::npos)
                steps += line.substr(at + run.size()) + "\n";
    }
    ASSERT_EQ(std::ranges::count(steps, '\n'), 3);
    const Outcome equal = run_lines(steps);
    EXPECT_EQ(equal.code, 0) << equal.err;
    Picture other = picture("expected/room.0001.png");
    for (float& value : other.pixels) value = 1 - value;
    ASSERT_TRUE(write_picture(path("expected/room.0001.png"), other));
    fs::remove(path("differing.html"));
    const Outcome differs = run_lines(steps);
    EXPECT_EQ(differs.code, 3) << differs.err;
    EXPECT_TRUE(fs::exists(path("differing.html"))) << "it is what the workflow keeps";
}

TEST_F(CliRecipes, WhyIsMyEffectLeftOut) { try_all("Why is my effect left out?"); }

TEST_F(CliRecipes, Colours) { try_all("Colours"); }

}  // namespace
}  // namespace darkroom
