// SPDX-License-Identifier: MIT
// Panels of edit in windows of several sizes: moved, closed, brought back and remembered, by the mouse; and pictures
// that have fewer pixels while they move.
#include <fmt/format.h>

#include "image/compare/compare.hpp"
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
    /// The picture's size, and that of what is drawn for it.
    [[nodiscard]] std::string sizes() const {
        const std::string text = ask("frames", "frames: ");
        return text.substr(text.find(", ") + 2);
    }
    /// Drags the first slider of an effect to and fro until less is drawn than is shown, and gives what the display
    /// shows then.
    [[nodiscard]] Picture while_dragged(const std::string& effect, const std::string& slider) const {
        click("stack/" + effect);
        const auto [left, top, right, bottom] = place(slider);
        const std::array<int, 4> picture = place("panel/Picture");
        const std::string whole = sizes();
        const auto move_to = [&](int x) {
            EXPECT_EQ(shell(fmt::format("xdotool mousemove --window {} {} {}", window(), x, (top + bottom) / 2)), 0);
        };
        move_to((left + right) / 2);
        EXPECT_EQ(shell("xdotool mousedown 1"), 0);
        Picture out;
        int step = 0;
        EXPECT_TRUE(wait_until(
            [&] {
                move_to((left + right) / 2 + step++ % 3);
                if (sizes() == whole) return false;
                out = seen(picture);
                move_to((left + right) / 2 + step++ % 3);
                return sizes() != whole;
            },
            60))
            << whole;
        EXPECT_EQ(shell("xdotool mouseup 1"), 0);
        EXPECT_TRUE(wait_until([&] { return sizes() == whole; }, 60)) << whole;
        return out;
    }
    /// Of what stands in the window, by the mean of FLIP.
    [[nodiscard]] double off(const Picture& moved) const {
        (void)ask("frames", "frames: ");
        const Result<Comparison> result = compare(seen(place("panel/Picture")), moved);
        EXPECT_TRUE(result) << result.error().text;
        return result ? result->flip_mean : 1;
    }
    std::string heavy_look() const {
        return write("heavy.toml",
                     "[[stack]]\neffect = \"ssao\"\n[[stack]]\neffect = \"bloom\"\n[[stack]]\neffect = "
                     "\"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    }
    void store(const std::string& frame, const std::string& time = "0") const {
        ASSERT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "1280x720", "--time", time, "-o",
                       path("r.png"), "--frame", path(frame)})
                      .code,
                  0);
    }
};

TEST_F(CliViewerSpeed, AStoredFrameKeepsItsPictureWhileASliderIsDragged) {
    store("frame.exr");
    start({"edit", path("frame.exr"), "--look", heavy_look(), "--size", "1600x900"});
    EXPECT_FALSE(shot().empty());
    const Picture moved = while_dragged("bloom", "bloom.intensity");
    EXPECT_LT(off(moved), 0.1);
    press("ctrl+s", "saved heavy.toml");
    leave();
}

TEST_F(CliViewerSpeed, FramesOfASequenceKeepTheirPictureWhileASliderIsDragged) {
    for (const char* const number : {"0", "1"}) store(fmt::format("shot.000{}.exr", number), number);
    start({"edit", path("shot.####.exr"), "--look", heavy_look(), "--fps", "24", "--size", "1600x900", "--paused"});
    EXPECT_FALSE(shot().empty());
    press("period");
    EXPECT_FALSE(shot().empty());
    const Picture moved = while_dragged("bloom", "bloom.intensity");
    EXPECT_LT(off(moved), 0.1);
    press("ctrl+s", "saved heavy.toml");
    leave();
}

TEST_F(CliViewerSpeed, WhatAHandMovesHasFewerPixelsAndWhatIsStoredAll) {
    const std::string whole = "1280x720 from 1280x720";
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "1280x720"});
    ASSERT_EQ(shell("xdotool keydown w"), 0);
    EXPECT_TRUE(wait_until([&] { return sizes() != whole; }, 60)) << sizes();
    EXPECT_EQ(shot().width, 1280U);
    ASSERT_EQ(shell("xdotool keyup w"), 0);
    // The time runs on.
    EXPECT_TRUE(wait_until([&] { return sizes() == whole; }, 60)) << sizes();
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_EQ(sizes(), whole);
    leave();
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "1280x720", "--full-size"});
    ASSERT_EQ(shell("xdotool keydown w"), 0);
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_EQ(sizes(), whole);
    ASSERT_EQ(shell("xdotool keyup w"), 0);
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
    EXPECT_TRUE(wait_until([&] { return sizes() == "640x360 from 213x120"; }, 60)) << sizes();
    // What is stored has all lines, from the frame's own place within the pixel.
    EXPECT_EQ(shot().width, 640U);
    press("ctrl+c", "stored frame-0001.exr");
    const Result<FrameFile> frame = read_frame(path("frame-0001.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(frame->color.height, 360U);
    ASSERT_TRUE(frame->camera.jitter);
    EXPECT_NE(*frame->camera.jitter, frame->camera.previous_jitter);
    press("p", "P pause: on");
    EXPECT_TRUE(wait_until([&] { return sizes() == "640x360 from 640x360"; }, 60)) << sizes();
    leave();
    begin({"--frame-time", "1000"});
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_EQ(sizes(), "640x360 from 640x360");
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
