// SPDX-License-Identifier: MIT
// Histories through the built program: a frame of a sequence is the same wherever the sequence begins.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using test::content;
using test::Outcome;

constexpr double half_a_code = 0.5 / 255;

class CliHistory : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"recursive_blend", "frame_blend", "tonemap"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
        test::CliFixture::SetUp();
    }
    void make_files() override {
        write("trails.toml",
              "format = 1\n"
              "[[stack]]\neffect = \"tonemap\"\ncurve = \"linear\"\n"
              "[[stack]]\neffect = \"recursive_blend\"\nweight = 0.8\n"
              "[[stack]]\neffect = \"frame_blend\"\n");
    }
    [[nodiscard]] FrameFile frame(const std::string& name) const {
        Result<FrameFile> read = read_frame(path(name), {});
        EXPECT_TRUE(read) << read.error().text;
        return read ? std::move(*read) : FrameFile{};
    }
    /// Largest difference of two pictures; of other sizes 1e9.
    [[nodiscard]] double difference(const std::string& a, const std::string& b) const {
        const std::vector<float> one = frame(a).color.pixels, other = frame(b).color.pixels;
        if (one.size() != other.size() || one.empty()) return 1e9;
        double worst = 0;
        for (std::size_t i = 0; i < one.size(); ++i)
            worst = std::max(worst, std::abs(static_cast<double>(one[i]) - static_cast<double>(other[i])));
        return worst;
    }
    [[nodiscard]] Outcome run_into(const std::string& folder, std::vector<std::string> arguments,
                                   const std::string& look = "trails.toml") const {
        fs::create_directories(path(folder));
        arguments.insert(arguments.end(), {"-o", path(folder) + "/%04d.exr", "--bits", "float", "--look", path(look)});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return outcome;
    }
    static std::string file(const std::string& folder, int number) {
        return fmt::format("{}/{:04}.exr", folder, number);
    }
};

/// A light that goes through the picture, and flickers.
class CliHistoryOfFiles : public CliHistory {
  protected:
    static constexpr int count = 90;

    void make_files() override {
        CliHistory::make_files();
        for (int number = 1; number <= count; ++number) {
            FrameFile made;
            made.color = Picture(16, 8);
            for (std::uint32_t y = 0; y < 8; ++y)
                for (std::uint32_t x = 0; x < 16; ++x) {
                    const bool is_light = (static_cast<int>(x) + number) % 8 < 2;
                    float* const pixel = made.color.at(x, y);
                    pixel[0] = is_light ? 1.0f : 0.0f;
                    pixel[1] = number % 3 == 0 ? 1.0f : 0.125f;
                    pixel[2] = number < 20 ? 1.0f : 0.0f;
                    pixel[3] = 1;
                }
            ASSERT_TRUE(write_frame(path(fmt::format("f.{:04}.exr", number)), made));
        }
    }
    [[nodiscard]] Outcome develop(const std::string& folder, std::vector<std::string> flags,
                                  const std::string& input = "f.%04d.exr") const {
        flags.insert(flags.begin(), {"develop", path(input)});
        return run_into(folder, flags);
    }
};

TEST_F(CliHistoryOfFiles, APieceIsTheWholeToHalfACode) {
    for (const char* const rate : {"30", "60", "144"}) {
        SCOPED_TRACE(rate);
        EXPECT_EQ(develop("whole", {"--fps", rate}).code, 0);
        EXPECT_EQ(develop("piece", {"--fps", rate, "--frames", "85-90"}).code, 0);
        EXPECT_FALSE(fs::exists(path(file("piece", 84))));
        for (int number = 85; number <= count; ++number)
            EXPECT_LE(difference(file("piece", number), file("whole", number)), half_a_code) << number;
        fs::remove_all(path("piece"));
        fs::remove_all(path("whole"));
    }
}

TEST_F(CliHistoryOfFiles, WithoutTheFramesBeforeItIsAnotherPicture) {
    EXPECT_EQ(develop("whole", {"--fps", "60"}).code, 0);
    EXPECT_EQ(develop("bare", {"--fps", "60"}, "f.%04d.exr[85-90]").code, 0);
    EXPECT_GT(difference(file("bare", 85), file("whole", 85)), 20 * half_a_code);
}

TEST_F(CliHistoryOfFiles, ReferencesKeepHistoriesToo) {
    EXPECT_EQ(develop("gpu", {"--fps", "60", "--frames", "60-66"}).code, 0);
    EXPECT_EQ(develop("reference", {"--fps", "60", "--frames", "60-66", "--reference"}).code, 0);
    for (int number = 60; number <= 66; ++number)
        EXPECT_LE(difference(file("gpu", number), file("reference", number)), half_a_code) << number;
    EXPECT_GT(difference(file("reference", 60), file("reference", 61)), half_a_code);
}

TEST_F(CliHistoryOfFiles, AMissingFrameIsACut) {
    // Frames that lie apart are developed each with those before it, not with each other.
    EXPECT_EQ(develop("whole", {"--fps", "60", "--frames", "1-90"}).code, 0);
    fs::create_directories(path("holes"));
    for (int number = 1; number < 90; ++number)
        if (number != 70) fs::copy_file(path(file("whole", number)), path(file("holes", number)));
    EXPECT_EQ(develop("holes", {"--fps", "60", "--skip-existing"}).code, 0);
    for (const int number : {70, 90})
        EXPECT_LE(difference(file("holes", number), file("whole", number)), half_a_code) << number;
}

TEST_F(CliHistory, ARenderedPieceIsTheWholeToHalfACode) {
    write("yard.scene.toml", R"([scene]
name = "yard"
[camera]
position = [0, 1.5, 4]
target = [0, 0.5, 0]
[entities.box]
bounds = { min = [-0.5, 0, -0.5], max = [0.5, 1, 0.5] }
material = { color = [0, 0, 0], emissive = [1, 0.5, 0.25], emissive_strength = 1 }
[[entities.box.transform.path]]
time = 0
position = [-2, 0, 0]
[[entities.box.transform.path]]
time = 2
position = [2, 0, 0]
)");
    // A script that remembers, and gives the histories a longer memory than the look does.
    write("longer.lua",
          "local n = 0\n"
          "engine.on_frame('longer', function()\n"
          "  n = n + 1\n"
          "  engine.cvar_set('recursive_blend.weight', n < 20 and 0.9 or 0.5 + n / 100)\n"
          "end)\n");
    write("longer.toml",
          "[[stack]]\neffect = \"tonemap\"\ncurve = \"linear\"\n"
          "[[stack]]\neffect = \"recursive_blend\"\nweight = 0.1\n[ui]\ncontrollers = [\"longer.lua\"]\n");
    for (const std::string look : {"trails.toml", "longer.toml"}) {
        const auto render = [&](const std::string& folder, const std::string& frames) {
            const Outcome run = run_into(
                folder, {"render", path("yard.scene.toml"), "--size", "32x18", "--fps", "24", "--frames", frames},
                look);
            EXPECT_EQ(run.code, 0) << run.err;
        };
        const std::string whole = "whole_" + look, piece = "piece_" + look;
        render(whole, "0-30");
        render(piece, "28-30");
        EXPECT_GT(difference(file(whole, 28), file(whole, 29)), 20 * half_a_code) << "something moves";
        for (int number = 28; number <= 30; ++number)
            EXPECT_LE(difference(file(piece, number), file(whole, number)), half_a_code) << look << " " << number;
    }
}

// Stripes of one pixel 5 m away, which move by 4.3 pixels, by nothing but what the file says of the camera before: it
// has gone aside by 10 cm, or its lens was shifted, or its jitter was another.
TEST_F(CliHistory, ThePreviousCameraOfAFileIsItsMotion) {
    if (find_effect("motion_blur") == nullptr) GTEST_SKIP() << "this build has no effect motion_blur";
    constexpr std::uint32_t columns = 48, rows = 200;
    write("smear.toml",
          "[[stack]]\neffect = \"motion_blur\"\nshutter_angle = 360\nsamples = 32\nresolution = \"full\"\n");
    FrameFile made;
    made.color = Picture(columns, rows);
    for (std::uint32_t y = 0; y < rows; ++y)
        for (std::uint32_t x = 0; x < columns; ++x) std::fill_n(made.color.at(x, y), 4, x % 2 == 0 ? 1.0F : 0.0F);
    made.depth = Plane<1>(columns, rows);
    std::ranges::fill(made.depth->values, 5.0F);
    made.camera.world_to_camera = Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Matrix lens = perspective(50, double{columns} / rows);
    made.camera.projection = lens;
    const std::array<float, 2> shift{4.3F, 0};
    const FrameCamera still = made.camera;
    for (const std::string_view moved : {"", "view", "projection", "jitter"}) {
        made.camera = still;
        if (moved == "view")
            made.camera.previous_world_to_camera = Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1F, 0, 0, 1};
        if (moved == "projection") made.camera.previous_projection = jittered(lens, shift, {columns, rows});
        if (moved == "jitter") made.camera.previous_jitter = shift;
        const bool has_moved = !moved.empty();
        ASSERT_TRUE(write_frame(path("walk.exr"), made));
        EXPECT_EQ(
            run({"develop", path("walk.exr"), "--look", path("smear.toml"), "-o", path("out.exr"), "--bits", "float"})
                .err,
            "");
        const Picture out = frame("out.exr").color;
        ASSERT_EQ(out.pixels.size(), made.color.pixels.size());
        for (std::uint32_t y = 0; y < rows; ++y)
            for (std::uint32_t x = 4; x < columns - 4; ++x)
                ASSERT_NEAR(out.at(x, y)[1], has_moved ? 0.5F : made.color.at(x, y)[1], has_moved ? 0.25F : 0.0F)
                    << moved << " at " << x << ", " << y;
    }
}

}  // namespace
}  // namespace darkroom
