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
    /// Is there a picture beside this row of a menu?
    [[nodiscard]] bool has_picture(const std::string& row) {
        const auto [left, top, right, bottom] = place(row + ".picture");
        const std::string file = fmt::format("darkroom-window-{:04}.png", ++window_shots_);
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
    }
    /// Until what was just opened is there to be typed into.
    static void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(700)); }

  private:
    int window_shots_ = 0;
};

TEST_F(CliViewerTasks, OpensASceneAndWalks) {
    std::filesystem::copy_file(scenes_folder + "dungeon.scene.toml", path("dungeon.scene.toml"));
    start({"edit", frame("frame.exr"), "--size", "1280x720", "--paused"});
    click("view/open");
    settle();
    type("dungeon.scene");
    press("Return", "opened dungeon.scene.toml");
    EXPECT_TRUE(wait_until([&] { return shot().width > 160; }, 60)) << "as large as its place";
    const Picture opened = shot();
    const auto [x, y] = middle("panel/Picture");
    drag({x, y}, {x + 120, y});
    const Picture turned = shot();
    EXPECT_GT(difference(opened, turned), 0.1) << "a drag orbits";
    press("v", "V: the camera flies");
    ASSERT_EQ(shell("xdotool keydown w sleep 1 keyup w"), 0);
    EXPECT_GT(difference(turned, shot()), 0.1) << "W flies";
    press("space", "Space: the scene's camera");
    EXPECT_EQ(difference(opened, shot()), 0);
    leave();

    start({"play", scenes_folder + "dungeon.scene.toml", "--size", "640x360", "--paused"});
    const Picture first = shot();
    ASSERT_EQ(shell(fmt::format("xdotool mousemove --window {} 320 180", window())), 0);
    ASSERT_EQ(shell("xdotool mousemove_relative 60 0"), 0);
    EXPECT_EQ(difference(first, shot()), 0) << "nobody has taken the mouse";
    ASSERT_EQ(shell("xdotool mousedown 1 sleep 0.5 mouseup 1"), 0);
    settle();
    ASSERT_EQ(shell("xdotool mousemove_relative 200 0"), 0);
    EXPECT_TRUE(wait_until([&] { return difference(first, shot()) > 0.1; }, 30)) << "it looks round";
    const Picture looked = shot();
    ASSERT_EQ(shell("xdotool keydown w sleep 1 keyup w"), 0);
    EXPECT_GT(difference(looked, shot()), 0.1) << "W walks";
    press("Escape");
    leave();
}

TEST_F(CliViewerTasks, AddsAnEffectSetsItAndSaves) {
    const std::string text = "[post_process]\nbloom_intensity = 0.2\n";
    const std::string look = write("my.toml", text);
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    const Picture before = shot();
    click("stack/add");
    settle();
    type("posterize");
    settle();
    click("add/posterize");
    settle();
    const Picture added = shot();
    EXPECT_GT(difference(before, added), 0) << "it is on, and its panel is open";
    const auto [left, top, right, bottom] = place("posterize.levels");
    drag({(left + right) / 2, (top + bottom) / 2}, {left + 8, (top + bottom) / 2});
    EXPECT_GT(difference(added, shot()), 0);
    press("ctrl+s", "saved my.toml");
    const std::string saved = content(look);
    EXPECT_TRUE(saved.starts_with(text)) << saved;
    EXPECT_NE(saved.find("posterize_enabled = true"), std::string::npos) << saved;
    EXPECT_NE(saved.find("posterize_levels = "), std::string::npos) << saved;
    leave();
}

TEST_F(CliViewerTasks, MendsABrokenEffectFromItsMessage) {
    const std::string good =
        "// @effect tint: Tints.\n// @param float amount = 0.5 in [0, 1]: How much.\n\n"
        "vec4 tint(vec4 color, Pixel pixel, Tint parameters) {\n    return color * parameters.amount;\n}\n";
    write("tint.glsl", good);
    const std::string look =
        write("my.toml",
              "[[stack]]\neffect = \"tint.glsl\"\n[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    const std::string editor = write("editor.sh", "#!/bin/sh\n[ \"$1\" = +5 ] && sed -i s/amonut/amount/ \"$2\"\n");
    std::filesystem::permissions(editor, std::filesystem::perms::owner_all);
    setenv("VISUAL", editor.c_str(), 1);
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    const Picture before = shot();
    std::string broken = good;
    broken.replace(broken.find(".amount"), 7, ".amonut");
    write("tint.glsl", broken);
    EXPECT_TRUE(wait_until([&] { return complained().find("tint.glsl:5") != std::string::npos; }, 60)) << said();
    EXPECT_EQ(difference(before, shot()), 0) << "the last good picture stays";
    click("message/0");
    EXPECT_TRUE(wait_until([&] { return count("read tint.glsl again") == 2; }, 60)) << said() << complained();
    EXPECT_TRUE(wait_until([&] { return ask("messages", "messages: ") == "0"; }, 60)) << said();
    EXPECT_EQ(difference(before, shot()), 0);
    unsetenv("VISUAL");
}

TEST_F(CliViewerTasks, ALookComesByItsWeightAndByDistance) {
    const auto exposed = [](const std::string& exposure) {
        return "[[stack]]\neffect = \"exposure\"\nexposure = " + exposure +
               "\n\n[[stack]]\neffect = \"tonemap\"\n\n[[stack]]\neffect = \"encode\"\n";
    };
    const std::string look = write("my.toml", exposed("1.0"));
    write("night.toml", exposed("0.1"));
    start({"edit", scenes_folder + "dungeon.scene.toml", "--look", look, "--size", "1600x900", "--paused"});
    const Picture before = shot();
    click("stack/add_layer");
    settle();
    type("night");
    settle();
    click("mover/file");
    settle();
    type("night.toml");
    press("Return");
    settle();
    const auto [left, top, right, bottom] = place("layer/night.weight");
    drag({left + 8, (top + bottom) / 2}, {right - 8, (top + bottom) / 2});
    const Picture night = shot();
    EXPECT_GT(difference(before, night), 0.1) << "it gets dark";
    click("layer/distance");
    settle();
    EXPECT_LT(difference(before, shot()), difference(before, night)) << "the camera is far from the point";
    press("ctrl+s", "saved my.toml");
    const std::string saved = content(look);
    EXPECT_NE(saved.find("look = \"night.toml\""), std::string::npos) << saved;
    EXPECT_NE(saved.find("distance = {"), std::string::npos) << saved;
    click("mover/remove");
    EXPECT_TRUE(wait_until([&] { return difference(before, shot()) == 0; }, 30)) << "as it was";
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look).find("[[layer]]"), std::string::npos) << content(look);
    leave();
}

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
    type("vignette");
    EXPECT_TRUE(wait_until([&] { return has_picture("add/vignette"); }, 240));
    press("Escape");
    click("stack/add");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    type("second picture");
    EXPECT_TRUE(wait_until([&] { return has_picture("add/blend"); }, 60)) << "the scene stands in for the second";
    press("Escape");
    leave();
}

TEST_F(CliViewerTasks, ALookThatShipsIsTakenByItsPicture) {
    const std::string text = "[post_process]\nbloom_intensity = 0.2\n";
    const std::string look = write("my.toml", text), stored = frame("frame.exr");
    ASSERT_EQ(run({"develop", stored, "--look", "scene_linear", "-o", path("developed.png")}).code, 0);
    start({"edit", stored, "--look", look, "--size", "1280x720"});
    const Picture before = shot(), developed = picture("developed.png");
    ASSERT_GT(difference(before, developed), 0.02);
    click("stack/looks");
    settle();
    type("scene");
    EXPECT_TRUE(wait_until([&] { return has_picture("looks/scene_linear"); }, 240));
    press("Return");
    EXPECT_TRUE(wait_until([&] { return difference(shot(), developed) <= 1.001 / 255; }, 60));
    EXPECT_EQ(content(look), text) << "nothing is saved yet";
    press("ctrl+z", "undo: look scene_linear");
    EXPECT_TRUE(wait_until([&] { return difference(before, shot()) == 0; }, 60));
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

TEST_F(CliViewerTasks, WhatWasOfferedStaysUntilItIsSettled) {
    const std::string text = "[post_process]\nbloom_intensity = 0.2\nfog_density = 0.05\n";
    const std::string look = write("my.toml", text);
    const std::filesystem::path first = path(".my.toml.unsaved"), second = path(".my.toml.2.unsaved");
    // Another process has this number now, whatever wrote the file.
    write(".my.toml.unsaved", "# Unsaved edits of process 1\n[post_process]\nbloom_intensity = 0.2\n");
    const std::string left = content(first);
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    EXPECT_TRUE(wait_for("unsaved edits of my.toml are there"));
    click("question/cancel");
    press("F8", "F8 fog: off");
    EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(second); }, 30)) << "what comes behind it is kept, too";
    EXPECT_EQ(content(first), left);
    kill(viewer().id(), SIGKILL);
    ASSERT_EQ(viewer().wait(std::chrono::seconds(60)), 128);
    // One that cannot be taken is not lost by the try.
    write(".my.toml.unsaved", "# Unsaved edits of process 1\n[post_process\n");
    start({"edit", path("frame.exr"), "--look", look, "--size", "1280x720"});
    EXPECT_TRUE(wait_for("unsaved edits of my.toml are there"));
    click("question/0");
    EXPECT_TRUE(wait_until([&] { return !complained().empty(); }, 30));
    EXPECT_TRUE(std::filesystem::exists(first));
    EXPECT_TRUE(std::filesystem::exists(second));
    kill(viewer().id(), SIGKILL);
    ASSERT_EQ(viewer().wait(std::chrono::seconds(60)), 128);
    EXPECT_EQ(content(look), text);
}

TEST_F(CliViewerTasks, ALinkInPlaceOfUnsavedEditsIsNotFollowed) {
    const std::string look = write("my.toml", "[post_process]\nfog_density = 0.05\n");
    write("victim", "# Unsaved edits of process 1\nvictim\n");
    std::filesystem::create_symlink("victim", path(".my.toml.unsaved"));
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    press("F8", "F8 fog: off");
    EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(path(".my.toml.2.unsaved")); }, 30));
    EXPECT_EQ(count("unsaved edits of"), 0U);
    press("ctrl+z", "undo: F8 fog: off");
    EXPECT_TRUE(wait_until([&] { return !std::filesystem::exists(path(".my.toml.2.unsaved")); }, 30));
    EXPECT_EQ(content(path("victim")), "# Unsaved edits of process 1\nvictim\n");
    EXPECT_TRUE(std::filesystem::is_symlink(path(".my.toml.unsaved")));
    leave();
}

}  // namespace
}  // namespace darkroom::test
