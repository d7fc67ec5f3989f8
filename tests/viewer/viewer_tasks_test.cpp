// SPDX-License-Identifier: MIT
// What somebody comes to the windows for, done with mouse and keys alone: a scene is walked through, a frame graded, an
// effect added and saved, a broken one mended, a sequence scrubbed and two looks compared. And nothing is lost.
#include <fmt/format.h>
#include <signal.h>

#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

class CliViewerTasks : public ViewerFixture {
  protected:
    std::string frame(const std::string& name, const std::string& exposure = "1") {
        EXPECT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "160x90", "--exposure", exposure, "-o",
                       path("r.png"), "--frame", path(name)})
                      .code,
                  0);
        return path(name);
    }
    void type(const std::string& text) const { ASSERT_EQ(shell(fmt::format("xdotool type --delay 60 '{}'", text)), 0); }
    [[nodiscard]] std::array<int, 2> middle(const std::string& name) const {
        const auto [left, top, right, bottom] = place(name);
        return {(left + right) / 2, (top + bottom) / 2};
    }
};

TEST_F(CliViewerTasks, GradesAFrameByWheels) {
    const std::string look = write("my.toml",
                                   "[[stack]]\neffect = \"color_grade\"\n\n[[stack]]\neffect = \"tonemap\"\n"
                                   "\n[[stack]]\neffect = \"encode\"\n");
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1600x900"});
    const Picture before = shot();
    click("stack/color_grade");
    const auto [left, top, right, bottom] = place("color_grade.gain");
    const int radius = (right - left) / 2;
    drag({left + radius, top + radius}, {left + radius - 10, top + radius - 25});
    EXPECT_GT(difference(before, shot()), 0) << "it gets redder";
    press("ctrl+s", "saved my.toml");
    EXPECT_NE(content(look).find("gain = ["), std::string::npos) << content(look);
    leave();
}

TEST_F(CliViewerTasks, ScrubsASequenceAndComparesTwoLooks) {
    for (const int number : {1, 2, 3, 4}) frame(fmt::format("shot.{:04}.exr", number));
    const std::string look = write("my.toml", "[post_process]\nexposure = 2.0\n");
    write("other.toml", "[post_process]\nexposure = 0.2\n");
    start({"edit", path("shot.####.exr"), "--look", look, "--fps", "24", "--size", "1600x900"});
    press("p", "P pause: on");
    press("period", "frame ");
    press("comma", "frame ");
    // Between two frames it goes round by itself.
    const auto [left, top, right, bottom] = place("view/frame");
    drag({right - 4, (top + bottom) / 2}, {left + 4, (top + bottom) / 2});
    press("period", "frame 2 of 4: shot.0002.exr");
    click("time/in");
    press("period", "frame 3 of 4: shot.0003.exr");
    click("time/out");
    press("period", "frame 2 of 4: shot.0002.exr");
    press("comma", "frame 3 of 4: shot.0003.exr");
    click("time/all");
    press("period", "frame 4 of 4: shot.0004.exr");
    // Without a loop it stands at its end.
    click("time/loop");
    press("p", "P pause: off");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    press("period", "frame 1 of 4: shot.0001.exr");

    press("b", "B compare: on");
    const auto [from_x, from_y] = middle("view/right");
    drag({from_x, from_y}, {from_x, from_y});
    press("Down");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    press("space");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    type("other.toml");
    press("Return", "compares with other.toml");
    const auto window = [&](const char* number) {
        press("shift+F12", fmt::format("stored darkroom-window-{}.png", number));
        return picture(fmt::format("darkroom-window-{}.png", number));
    };
    const Picture two_looks = window("0001");
    click("view/other");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    type("r.png");
    press("Return", "compares with r.png");
    EXPECT_GT(difference(two_looks, window("0002")), 0.05) << "a picture is beside the look";
    EXPECT_EQ(complained(), "");
    leave();
}

TEST_F(CliViewerTasks, FiresAPulse) {
    const std::string look = write("my.toml",
                                   "[[stack]]\neffect = \"exposure\"\n\n[[stack]]\neffect = \"tonemap\"\n\n[[pulse]]\n"
                                   "event = \"hit\"\nparameter = \"exposure.exposure\"\namount = 1.0\n");
    start({"edit", scenes_folder + "dungeon.scene.toml", "--look", look, "--size", "1280x720"});
    click("stack/pulse/0");
    const std::size_t before = count("fired hit: 1 pulse");
    click("fire/hit");
    EXPECT_TRUE(wait_until([&] { return count("fired hit: 1 pulse") > before; }, 30)) << said();
    leave();
}

TEST_F(CliViewerTasks, ALostDeviceIsMadeAnew) {
    const std::string library = std::string(test::binary_folder) + "/bin/darkroom_lose_device.so";
    if (!std::filesystem::exists(library)) GTEST_SKIP() << "sanitizers want to be first";
    const std::string look = write("my.toml", "[post_process]\nbloom_intensity = 0.2\nfog_density = 0.05\n");
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"}, {"env", "LD_PRELOAD=" + library});
    press("F8", "F8 fog: off");
    const Picture before = shot();
    for (int i = 0; i < 2; ++i) {
        const std::size_t known = count("the device was made anew");
        kill(viewer().id(), SIGUSR1);
        press("F5");  // whoever rests submits nothing
        EXPECT_TRUE(wait_until([&] { return count("the device was made anew") > known; }, 120))
            << said() << complained();
        press("ctrl+z", "undo: F5 bloom: off");
        EXPECT_EQ(difference(before, shot()), 0) << "the look goes on";
    }
    press("ctrl+s", "saved my.toml");
    leave();
}

TEST_F(CliViewerTasks, TheListOfEffectsShowsWhatTheyDo) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    click("stack/add");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    int shots = 0;
    const auto has_picture = [&](const std::string& effect) {
        const auto [left, top, right, bottom] = place("add/" + effect + ".picture");
        const std::string file = fmt::format("darkroom-window-{:04}.png", ++shots);
        press("shift+F12", "stored " + file);
        const Picture window = picture(file);
        if (window.width < static_cast<std::uint32_t>(right)) return false;
        float least = 1, most = 0;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const float green = window.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))[1];
                least = std::min(least, green);
                most = std::max(most, green);
            }
        return most - least > 0.2F;
    };
    type("vignette");
    EXPECT_TRUE(wait_until([&] { return has_picture("vignette"); }, 240));
    press("Escape");
    click("stack/add");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    type("second picture");
    EXPECT_TRUE(wait_until([&] { return has_picture("blend"); }, 60)) << "the scene stands in for the second";
    press("Escape");
    leave();
}

TEST_F(CliViewerTasks, WhatWasNotSavedIsOfferedAgain) {
    const std::string text = "[post_process]\nbloom_intensity = 0.2\nfog_density = 0.05\n";
    const std::string look = write("my.toml", text);
    const std::filesystem::path journal = path(".my.toml.unsaved");
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    press("F8", "F8 fog: off");
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(journal); }, 30));
    press("ctrl+z", "undo: F8 fog: off");
    EXPECT_TRUE(wait_until([&] { return !std::filesystem::exists(journal); }, 30)) << "nothing is unsaved";
    press("F8", "F8 fog: off");
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(journal); }, 30));
    kill(viewer().id(), SIGKILL);
    ASSERT_EQ(viewer().wait(std::chrono::seconds(60)), 128);
    EXPECT_EQ(content(look), text);

    start({"edit", path("frame.exr"), "--look", look, "--size", "1280x720"});
    EXPECT_TRUE(wait_for("unsaved edits of my.toml are there"));
    click("question/0");
    press("ctrl+s", "saved my.toml");
    EXPECT_NE(content(look), text);
    EXPECT_TRUE(wait_until([&] { return !std::filesystem::exists(journal); }, 30));
    press("ctrl+z", "undo: unsaved edits");
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look), text);
    leave();
}

}  // namespace
}  // namespace darkroom::test
