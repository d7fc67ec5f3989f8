// SPDX-License-Identifier: MIT
// What edit says, keeps and saves, driven by the mouse and keys of somebody who sees it for the first time.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

constexpr const char* tint =
    "// @effect tint: Tints.\n// @param float amount = 0.5 in [0, 1]: How much.\n\n"
    "vec4 tint(vec4 color, Pixel pixel, Tint parameters) {\n    return color * parameters.amount;\n}\n";

std::size_t times(const std::string& what, const std::string& in) {
    std::size_t found = 0;
    for (std::size_t at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++found;
    return found;
}

class CliViewerEdit : public ViewerFixture {
  protected:
    void TearDown() override {
        unsetenv("VISUAL");
        ViewerFixture::TearDown();
    }
    /// Of one frame without a camera, which is quick to develop.
    std::string frame(const std::string& name) {
        EXPECT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "160x90", "-o", path("r.png"),
                       "--frame", path(name)})
                      .code,
                  0);
        return path(name);
    }
    /// The messages that stand in the window.
    [[nodiscard]] std::string messages() {
        const std::size_t before = said().size();
        command("messages");
        EXPECT_TRUE(wait_until([&] { return said().find("messages: ", before) != std::string::npos; }, 60));
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return said().substr(before);
    }
    void type(const std::string& text) const { ASSERT_EQ(shell(fmt::format("xdotool type --delay 60 '{}'", text)), 0); }
    [[nodiscard]] bool complains(const std::string& line) const {
        return wait_until([&] { return complained().find(line) != std::string::npos; }, 60);
    }
    [[nodiscard]] std::string title() const { return answer("xdotool getwindowname " + window()); }
    /// CPU seconds of the program so far.
    [[nodiscard]] double cpu() {
        std::string text = content(fmt::format("/proc/{}/stat", viewer().id()));
        std::istringstream numbers(text.substr(text.rfind(')') + 1));
        std::string state;
        numbers >> state;
        double out = 0;
        for (int i = 4; i <= 15; ++i) {
            double number = 0;
            numbers >> number;
            if (i >= 14) out += number;
        }
        return out / static_cast<double>(sysconf(_SC_CLK_TCK));
    }
};

TEST_F(CliViewerEdit, ABrokenEffectSaysItsLineUntilItIsMended) {
    write("tint.glsl", tint);
    const std::string look =
        "[[stack]]\neffect = \"tint.glsl\"\n[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n";
    const std::string file = write("my.toml", look);
    start({"edit", frame("frame.exr"), "--look", file, "--size", "1280x720"});
    EXPECT_NE(messages().find("messages: 0"), std::string::npos);
    std::string broken = tint;
    broken.replace(broken.find(".amount"), 7, ".amonut");
    write("tint.glsl", broken);
    ASSERT_TRUE(complains("tint.glsl:5")) << said() << complained();
    EXPECT_EQ(count("read tint.glsl again"), 1U);
    EXPECT_EQ(times("tint.glsl:5", messages()), 1U);
    EXPECT_EQ(times("tint.glsl:5", complained()), 1U) << "once, however many frames go on without it: " << complained();
    write("tint.glsl", tint);
    EXPECT_TRUE(wait_until([&] { return messages().find("messages: 0") != std::string::npos; }, 60)) << complained();

    write("my.toml", look + "bogus = 3\n");
    ASSERT_TRUE(complains("my.toml:7:1: unknown key 'bogus'")) << said() << complained();
    EXPECT_EQ(times("warning: ", messages()), 1U);
    write("my.toml", look + "= = 3\n");
    ASSERT_TRUE(complains("my.toml:7:1: Error while parsing")) << said() << complained();
    write("my.toml", look + "bogus = 4\n");
    EXPECT_TRUE(wait_until(
        [&] {
            const std::string now = messages();
            return now.find("messages: 1") != std::string::npos && now.find("bogus' = 4") != std::string::npos;
        },
        60))
        << "what no longer holds is gone: " << messages();
    write("my.toml", look);
    EXPECT_TRUE(wait_until([&] { return messages().find("messages: 0") != std::string::npos; }, 60));
    EXPECT_EQ(times("Error while parsing", complained()), 1U) << complained();
}

TEST_F(CliViewerEdit, AClickOnAMessageOpensItsLine) {
    const std::string look = write("my.toml", "[post_process]\nbogus = 3\n");
    const std::string editor = write("editor.sh", "#!/bin/sh\necho \"$@\" > " + path("opened.txt") + "\n");
    std::filesystem::permissions(editor, std::filesystem::perms::owner_all);
    setenv("VISUAL", (editor + " -w").c_str(), 1);
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    EXPECT_EQ(times("bogus", complained()), 1U) << "told once, by the window: " << complained();
    click("message/0");
    EXPECT_TRUE(wait_until([&] { return content(path("opened.txt")) == fmt::format("-w +2 {}\n", look); }, 60))
        << content(path("opened.txt")) << said();
}

TEST_F(CliViewerEdit, UndoBehindASaveSavesTheBytesThatWere) {
    const std::string text = "# mine\n\n[post_process]\nbloom_intensity = 0.20  # it glows\n\n\nfog_density = 0.05\n";
    const std::string look = write("my.toml", text);
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    press("F5", "F5 bloom: off");
    press("F8", "F8 fog: off");
    press("ctrl+s", "saved my.toml");
    EXPECT_NE(content(look), text);
    press("ctrl+z", "undo: F8 fog: off");
    press("ctrl+z", "undo: F5 bloom: off");
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look), text);
    leave();
}

TEST_F(CliViewerEdit, AddingByKeyboardKeepsTheFlatTableOrAsks) {
    const std::string look = write("my.toml", "[post_process]\nbloom_intensity = 0.2\n");
    start({"edit", frame("frame.exr"), "--look", look, "--size", "1280x720"});
    click("stack/add");
    type("posterize");
    press("Return");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look).find("[[stack]]"), std::string::npos) << content(look);
    EXPECT_NE(content(look).find("posterize_enabled = true"), std::string::npos) << content(look);
    const std::string saved = content(look);
    click("stack/add");
    type("second picture");
    press("Return");
    click("question/cancel");
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look), saved);
    click("stack/add");
    type("second picture");
    press("Return");
    click("question/0");
    press("ctrl+s", "saved my.toml");
    EXPECT_NE(content(look).find("effect = \"blend\""), std::string::npos) << content(look);
}

TEST_F(CliViewerEdit, ALookWithoutANameAsksForOne) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    press("ctrl+s", "the look has no name yet");
    EXPECT_EQ(count("saved"), 0U) << said();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    type("mine");
    press("Return", "saved mine.toml");
    EXPECT_NE(content(path("mine.toml")).find("[post_process]"), std::string::npos);
}

TEST_F(CliViewerEdit, ALookIsShownOnTheFrameThatShipsAndAnotherCanBeOpened) {
    const std::string look = write("my.toml", "[post_process]\nbloom_intensity = 0.2\n");
    frame("other.exr");
    start({"edit", look, "--size", "1280x720"});
    EXPECT_EQ(title(), "window.exr - Darkroom");
    click("view/open");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    type("other.exr");
    press("Return", "opened other.exr");
    EXPECT_TRUE(wait_until([&] { return title() == "other.exr - Darkroom"; }, 30)) << title();
    EXPECT_TRUE(wait_until([&] { return shot().width == 160; }, 60));
    EXPECT_EQ(complained(), "");
    leave();
}

TEST_F(CliViewerEdit, NothingIsDrawnWhileNothingChanges) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    press("b", "B compare: on");
    press("b", "B compare: off");
    std::this_thread::sleep_for(std::chrono::seconds(5));
    const double before = cpu();
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_LT(cpu() - before, 0.5) << "CPU seconds of five";
    press("Tab", "Tab panels: off");
    press("Tab", "Tab panels: on");
    EXPECT_EQ(shot().width, 160U) << "it wakes up";
    leave();
}

TEST_F(CliViewerEdit, TheConsoleCompletesAndRecalls) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    press("grave", "console: on");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    // A key and what is typed behind it are seen in one frame where nobody waits.
    const auto tap = [&](const std::string& key) {
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        press(key);
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
    };
    type("vignette.inten");
    tap("Tab");
    type("0.25");
    tap("Return");
    const auto value = [&] {
        const std::size_t before = said().size();
        command("vignette.intensity");
        EXPECT_TRUE(
            wait_until([&] { return said().find("\"vignette.intensity\" is ", before) != std::string::npos; }, 60));
        const std::string text = said().substr(before);
        return text.substr(text.find("is ") + 3);
    };
    EXPECT_TRUE(wait_until([&] { return value().starts_with("\"0.25\""); }, 30)) << said();
    command("vignette.intensity 0.5");
    EXPECT_TRUE(wait_until([&] { return value().starts_with("\"0.5\""); }, 30)) << said();
    tap("Up");
    tap("Return");
    EXPECT_TRUE(wait_until([&] { return value().starts_with("\"0.25\""); }, 30)) << said();
    command("help vignette.intensity");
    EXPECT_TRUE(wait_for("vignette.intensity: ")) << said();
}

TEST_F(CliViewerEdit, PlayKeepsItsConfigurationAndBindsItsFirstFrame) {
    const std::string look = looks_folder + "visor.toml";
    const std::vector<std::string> arguments{"play",   scenes_folder + "dungeon.scene.toml", "--look", look, "--size",
                                             "320x180"};
    start(arguments);
    command("contrast 1.25");
    command("contrast");
    ASSERT_TRUE(wait_for("\"contrast\" is \"1.25\"")) << said() << complained();
    leave();
    EXPECT_NE(content(path("config/darkroom/console.cfg")).find("contrast"), std::string::npos);
    start(arguments);
    command("contrast");
    EXPECT_TRUE(wait_for("\"contrast\" is \"1.25\"")) << said() << complained();
    leave();
}

TEST_F(CliViewerEdit, BrokenFramesOfASequenceAreToldOnce) {
    frame("s.0001.exr");
    for (const char* const name : {"s.0002.exr", "s.0003.exr"}) write(name, "this is no frame");
    std::filesystem::copy_file(path("s.0001.exr"), path("s.0004.exr"));
    start({"edit", path("s.####.exr"), "--size", "1280x720", "--fps", "8"});
    ASSERT_TRUE(complains("s.0003.exr")) << said() << complained();
    std::this_thread::sleep_for(std::chrono::seconds(4));
    const std::string lines = complained();
    EXPECT_LE(std::ranges::count(lines, '\n'), 2) << lines;
    // They are shown once they are whole.
    for (const char* const name : {"s.0002.exr", "s.0003.exr"})
        std::filesystem::copy_file(path("s.0001.exr"), path(name), std::filesystem::copy_options::overwrite_existing);
    EXPECT_TRUE(wait_until(
        [&] {
            command("messages");
            return count("messages: 0") > 0;
        },
        30))
        << said();
}

TEST_F(CliViewerEdit, AFrameThatIsRenderedAnewIsReadAgain) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    const Picture before = shot();
    FrameFile bright;
    bright.color = Picture(before.width, before.height);
    for (float& value : bright.color.pixels) value = 0.5F;
    ASSERT_TRUE(write_frame(path("frame.exr"), bright));
    EXPECT_TRUE(wait_until([&] { return difference(before, shot()) > 0.1; }, 20));
    leave();
}

TEST_F(CliViewerEdit, TwoPicturesAtOnceHaveTwoNames) {
    start({"edit", frame("frame.exr"), "--size", "1280x720"});
    ASSERT_EQ(shell("xdotool key F12 key F12"), 0);
    ASSERT_TRUE(wait_until([&] { return count("stored darkroom-") == 2; }, 60)) << said();
    EXPECT_EQ(count("stored darkroom-0001.png"), 1U) << said();
    EXPECT_EQ(count("stored darkroom-0002.png"), 1U) << said();
    leave();
}

}  // namespace

}  // namespace darkroom::test
