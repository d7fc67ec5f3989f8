// SPDX-License-Identifier: MIT
// Panels of edit in windows of several sizes: moved, closed, brought back and remembered, by the mouse; and pictures
// that have fewer pixels while they move.
#include <fmt/format.h>

#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

struct Shown {
    const char* name;
    const char* size;
    int dots_per_inch;
    bool is_fullscreen;
};

class CliViewerPanels : public ViewerFixture, public testing::WithParamInterface<Shown> {
  protected:
    [[nodiscard]] int dots_per_inch() const override { return GetParam().dots_per_inch; }
    void open(const std::string& frame) {
        std::vector<std::string> line{"edit", frame, "--size", GetParam().size};
        if (GetParam().is_fullscreen) line.emplace_back("--fullscreen");
        start(line);
    }
    [[nodiscard]] int scale() const { return dots_per_inch() / 96; }
    [[nodiscard]] std::array<int, 2> middle(const std::string& name) const {
        const auto [left, top, right, bottom] = place(name);
        return {(left + right) / 2, (top + bottom) / 2};
    }
    /// Drags a line between panels, and returns where it is then.
    std::array<int, 2> move(const std::string& line, int right, int down) const {
        const std::array<int, 2> from = middle(line);
        const std::array<int, 2> to{from[0] + right * scale(), from[1] + down * scale()};
        drag(from, to);
        const std::array<int, 2> at = middle(line);
        EXPECT_NEAR(at[right != 0 ? 0 : 1], to[right != 0 ? 0 : 1], 8 * scale()) << line;
        return at;
    }
    void choose(const std::string& item) const {
        click("view/menu");
        click("menu/" + item);
    }
};

INSTANTIATE_TEST_SUITE_P(Windows, CliViewerPanels,
                         testing::Values(Shown{"Small", "1280x720", 96, false}, Shown{"Scaled", "1600x900", 192, false},
                                         Shown{"Fullscreen", "1280x720", 96, true}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST_P(CliViewerPanels, AreMovedClosedAndRemembered) {
    ASSERT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "160x90", "-o", path("r.png"), "--frame",
                   path("frame.exr")})
                  .code,
              0);
    open(path("frame.exr"));
    const bool is_column = GetParam().dots_per_inch > 96;
    const std::array<int, 2> stack = move("splitter/Stack", 60, 0), below = move("splitter/Below", 0, -40);
    const std::array<int, 2> other = is_column ? move("splitter/Column", 0, 50) : move("splitter/Parameters", -50, 0);
    click("close/Parameters");
    if (!is_column && !GetParam().is_fullscreen) {
        EXPECT_GT(place("panel/Picture")[2], other[0] + 100) << "the picture has its place";
    }
    choose("Status line");
    const std::array<int, 4> picture = place("panel/Picture");
    leave();

    open(path("frame.exr"));
    EXPECT_EQ(middle("splitter/Stack")[0], stack[0]) << "it is higher without the status line";
    EXPECT_NEAR(middle("splitter/Below")[1], below[1] + 26 * scale(), 26 * scale());
    EXPECT_EQ(place("panel/Picture"), picture);
    choose("Parameters");
    EXPECT_EQ(middle(is_column ? "splitter/Column" : "splitter/Parameters")[0], other[0]);
    click("close/Below");
    if (!GetParam().is_fullscreen) {
        EXPECT_GT(place("panel/Picture")[3], picture[3]);
    }
    choose("Put panels back");
    EXPECT_NE(middle("splitter/Stack")[0], stack[0]);
    press("question", "? keys: on");
    press("Escape", "? keys: off");
    leave();
}

class CliViewerSpeed : public ViewerFixture {
  protected:
    [[nodiscard]] std::string divisor() const {
        const std::string text = ask("frames", "frames: ");
        return text.substr(text.find(", ") + 2);
    }
};

TEST_F(CliViewerSpeed, WhatMovesHasFewerPixelsAndWhatIsStoredAll) {
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "1280x720"});
    EXPECT_TRUE(wait_until([&] { return divisor() == "1280x720 / 2" || divisor() == "1280x720 / 4"; }, 60))
        << divisor();
    EXPECT_EQ(shot().width, 1280U);
    press("p", "P pause: on");
    EXPECT_TRUE(wait_until([&] { return divisor() == "1280x720 / 1"; }, 60)) << divisor();
    leave();
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "1280x720", "--full-size"});
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_EQ(divisor(), "1280x720 / 1");
    leave();
}

// All pixels are alike, whatever a blur makes of them.
TEST_F(CliViewerSpeed, StoredFramesThatMoveAreSeenWhole) {
    constexpr std::uint32_t width = 1600, height = 900;
    FrameFile frame{.color = Picture(width, height), .velocity = Plane<2>(width, height), .exposure = 1.0F};
    for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = i % 4 == 3 ? 1.0F : 0.5F;
    for (const char* const name : {"f.0001.exr", "f.0002.exr", "f.0003.exr", "f.0004.exr", "f.0005.exr"})
        ASSERT_TRUE(write_frame(path(name), frame));
    std::string look;
    for (int i = 0; i < 8; ++i) look += "[[stack]]\neffect = \"gaussian_blur\"\nradius = 24\n\n";
    start({"play", path("f.####.exr"), "--fps", "24", "--look",
           write("blurred.toml", look + "[[stack]]\neffect = \"encode\"\n"), "--size", "1600x900"});
    ASSERT_TRUE(wait_until([&] { return divisor() == "1600x900 / 2" || divisor() == "1600x900 / 4"; }, 60))
        << divisor();
    for (int i = 0; i < 5; ++i) {
        // Below the pointer, which is in the middle.
        const Screen seen = screen();
        for (int y = 600; y < 700; ++y)
            for (int x = 700; x < 1200; ++x)
                for (const int code : seen.at(x, y)) ASSERT_NEAR(code, 188, 1) << x << ", " << y;
    }
    leave();
}

TEST_F(CliViewerSpeed, AFrameTimeDrawsASceneWithFewerLinesOfThePicture) {
    const std::string scene = scenes_folder + "showcase.scene.toml";
    const std::string look = write("gathers.toml",
                                   "[[stack]]\neffect = \"taa\"\n\n[[stack]]\neffect = \"tonemap\"\n"
                                   "\n[[stack]]\neffect = \"encode\"\n");
    const auto begin = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"play", scene, "--look", look, "--size", "640x360"});
        start(flags);
    };
    begin({"--frame-time", "0.5"});
    EXPECT_TRUE(wait_until([&] { return divisor() == "640x360 / 1 from 213x120"; }, 60)) << divisor();
    // What is stored has all lines, from the frame's own place within the pixel.
    EXPECT_EQ(shot().width, 640U);
    press("ctrl+c", "stored frame-0001.exr");
    const Result<FrameFile> frame = read_frame(path("frame-0001.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(frame->color.height, 360U);
    ASSERT_TRUE(frame->camera.jitter);
    EXPECT_NE(*frame->camera.jitter, frame->camera.previous_jitter);
    press("p", "P pause: on");
    EXPECT_TRUE(wait_until([&] { return divisor() == "640x360 / 1 from 640x360"; }, 60)) << divisor();
    leave();
    begin({"--frame-time", "1000"});
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_EQ(divisor(), "640x360 / 1 from 640x360");
    leave();

    write("gathers.toml", "[[stack]]\neffect = \"tonemap\"\n\n[[stack]]\neffect = \"encode\"\n");
    begin({"--paused", "--frame-time", "0.5"});
    const Picture from_all_lines = shot();
    leave();
    begin({"--paused"});
    EXPECT_LE(difference(from_all_lines, shot()), 1.001 / 255);
    leave();
}

}  // namespace
}  // namespace darkroom::test
