// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <random>

#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

class CliViewer : public ViewerFixture {
  protected:
    void write_grey_frame() {
        FrameFile frame;
        frame.color = Picture(64, 36);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = i % 4 == 3 ? 1.0F : 0.125F;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
};

TEST_F(CliViewer, APictureIsThatOfRender) {
    for (const auto& [scene, size] : {std::pair("dungeon", "320x180"), std::pair("showcase", "333x217")}) {
        const std::string file = scenes_folder + scene + ".scene.toml";
        const Outcome rendered = run(
            {"render", file, "--size", size, "--fps", "60", "--samples", "1", "--msaa", "4", "-o", path("render.png")});
        ASSERT_EQ(rendered.code, 0) << rendered.err;
        const Outcome shown = run({"play", file, "--size", size, "--screenshot", path("shown.png")});
        ASSERT_EQ(shown.code, 0) << shown.err;
        EXPECT_EQ(shown.err, "") << "the validation layer is silent";
        EXPECT_EQ(difference(picture("render.png"), picture("shown.png")), 0) << scene;
    }
}

TEST_F(CliViewer, EveryFlagOfThePicturesIsObeyed) {
    const std::string file = scenes_folder + "forge.scene.toml";
    const auto pictures = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> render{"render",    file, "--size", "160x90", "--fps", "60",
                                        "--samples", "1",  "--msaa", "4",      "-o",    path("render.png")};
        std::vector<std::string> play{"play", file, "--size", "160x90", "--screenshot", path("shown.png")};
        for (std::vector<std::string>* const line : {&render, &play}) {
            line->insert(line->end(), {"--fxaa-enabled", "off"});
            line->insert(line->end(), flags.begin(), flags.end());
            const Outcome outcome = run(*line);
            EXPECT_EQ(outcome.code, 0) << outcome.err;
        }
        return std::pair(picture("render.png"), picture("shown.png"));
    };
    const Picture plain = pictures({}).second;
    for (const std::vector<std::string>& flags :
         std::vector<std::vector<std::string>>{{"--exposure", "2"},
                                               {"--bloom-intensity", "0.6", "--bloom-threshold", "0.2"},
                                               {"--fog-density", "0.1"},
                                               {"--fog-height-falloff", "0.2"},
                                               {"--vignette-intensity", "0.9"},
                                               {"--ssao-intensity", "3"},
                                               {"--radial-blur", "2"},
                                               {"--chromatic-aberration", "0.05"},
                                               {"--tonemap-curve", "agx"},
                                               {"--dither-intensity", "0.1"},
                                               {"--layer", looks_folder + "daze.toml"},
                                               {"--no-postprocess", "--exposure", "3"}}) {
        const auto [rendered, shown] = pictures(flags);
        EXPECT_GT(difference(plain, shown), 2.0 / 255) << flags.front();
        EXPECT_LE(difference(rendered, shown), 1.001 / 255) << flags.front();
    }
}

// As `render` does: CliRenderPixels.TheScenesCameraSaysItsLens.
TEST_F(CliViewer, ALookOfAnotherFileHasTheLensOfTheScenesCamera) {
    const auto scene = [&](const std::string& name, const std::string& lens) {
        return write(name, "[camera]\nposition = [1, 3, 6]\ntarget = [0, 0.5, 0]\n" + lens +
                               "[entities.floor]\nbounds = { min = [-3, 0.01, -3], max = [3, 0.05, 3] }\n"
                               "[entities.box]\nbounds = { min = [-0.6, 0.05, -0.6], max = [0.6, 1.2, 0.6] }\n"
                               "material = { color = [0.8, 0.3, 0.1] }\n");
    };
    const std::string near = "aperture = 0.5\nfocus = 3\nsensor_height = 400\n",
                      far = "aperture = 0.5\nfocus = 9\nsensor_height = 400\n";
    const std::string file = scene("lens.scene.toml", near), plain = scene("plain.scene.toml", "");
    const std::string look = write("blurred.toml", "[post_process]\ndepth_of_field_enabled = true\n");
    const auto shown = [&](const std::string& command, const std::string& of, std::vector<std::string> flags) {
        flags.insert(flags.begin(),
                     {command, of, "--look", look, "--size", "960x600", "--screenshot", path("shown.png")});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture("shown.png");
    };
    for (const char* const command : {"play", "edit"}) {
        const Picture blurred = shown(command, file, {});
        EXPECT_EQ(difference(blurred, shown(command, plain,
                                            {"--depth-of-field-f-stop", "0.5", "--depth-of-field-focus-distance", "3",
                                             "--depth-of-field-sensor-height", "400"})),
                  0)
            << command;
        EXPECT_GT(difference(blurred, shown(command, plain, {})), 0) << command;
    }

    start({"edit", file, "--look", look, "--size", "800x600"});
    press("p", "P pause: on");
    const Picture before = shot();
    scene("lens.scene.toml", far);
    ASSERT_TRUE(wait_for("read lens.scene.toml again")) << said() << complained();
    EXPECT_GT(difference(before, shot()), 0) << "the camera is focused elsewhere";
    scene("lens.scene.toml", near);
    ASSERT_TRUE(wait_until([&] { return count("read lens.scene.toml again") == 2; }, 60)) << said() << complained();
    EXPECT_EQ(difference(before, shot()), 0);
    leave();
}

TEST_F(CliViewer, AStoredFrameIsDevelopedAsByDevelop) {
    ASSERT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "161x97", "-o", path("r.png"), "--frame",
                   path("frame.exr")})
                  .code,
              0);
    const std::string look = scenes_folder + "dungeon.scene.toml";
    ASSERT_EQ(run({"develop", path("frame.exr"), "--look", look, "-o", path("developed.png")}).code, 0);
    const Outcome shown = run({"edit", path("frame.exr"), "--look", look, "--screenshot", path("shown.png"),
                               "--window-screenshot", path("window.png")});
    ASSERT_EQ(shown.code, 0) << shown.err;
    EXPECT_EQ(shown.err, "");
    EXPECT_EQ(difference(picture("developed.png"), picture("shown.png")), 0);
    EXPECT_EQ(picture("window.png").width, 1600U);
    // Without a look, too.
    ASSERT_EQ(run({"develop", path("frame.exr"), "-o", path("developed.png")}).code, 0);
    ASSERT_EQ(run({"edit", path("frame.exr"), "--screenshot", path("shown.png")}).code, 0);
    EXPECT_EQ(difference(picture("developed.png"), picture("shown.png")), 0);
}

TEST_F(CliViewer, WhatAKeyStoresIsWhatDevelopMakes) {
    start({"edit", scenes_folder + "dungeon.scene.toml", "--size", "900x700"});
    press("p", "P pause: on");
    // Behind effects that were on for a while, too: nothing of them is left.
    for (int round = 0; round < 2; ++round) {
        const Picture stored = shot();
        press("ctrl+c", "stored frame-0001.exr");
        ASSERT_EQ(run({"develop", path("frame-0001.exr"), "--look", scenes_folder + "dungeon.scene.toml", "-o",
                       path("developed.png")})
                      .code,
                  0);
        EXPECT_EQ(difference(picture("developed.png"), stored), 0);
        std::filesystem::remove(path("frame-0001.exr"));
        for (int i = 0; i < 2; ++i) press("F10", "F10 volumetric: ");
    }
    EXPECT_EQ(complained(), "");
}

class CliViewerKeys : public CliViewer, public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(Commands, CliViewerKeys, testing::Values("play", "edit"));

TEST_P(CliViewerKeys, DoWhatTheySay) {
    const bool is_play = GetParam() == std::string("play");
    // What was edited and is not saved, edit asks about.
    const auto end = [&] {
        if (is_play) leave();
        EXPECT_EQ(complained(), "");
    };
    start({GetParam(), scenes_folder + "showcase.scene.toml", "--size", is_play ? "320x180" : "1280x720",
           "--bloom-intensity", "0.3", "--fog-density", "0.05", "--dither-intensity", "0.1", "--ssao-intensity", "1"});
    press("p", "P pause: on");
    const Picture before = shot();
    for (const auto& [key, line] :
         {std::pair("F1", "F1 debug view: wireframe"), std::pair("F4", "F4 shadows: "), std::pair("F5", "F5 bloom: "),
          std::pair("F6", "F6 post-processing: "), std::pair("F7", "F7 ssao: "), std::pair("F8", "F8 fog: "),
          std::pair("F9", "F9 dither: ")}) {
        press(key, line);
        EXPECT_GT(difference(before, shot()), 0) << key << " changes the picture";
        if (key == std::string("F1"))
            for (const char* const view : {"normals", "depth", "uv", "unlit", "metal-rough", "none"})
                press(key, std::string("F1 debug view: ") + view);
        else
            press(key, line);
        EXPECT_EQ(difference(before, shot()), 0) << key << " pressed again brings it back";
    }
    const std::uint32_t width = before.width;
    press("F11");
    EXPECT_TRUE(wait_until([&] { return is_play ? shot().width == 1920 : shot().width > width; }, 60))
        << "the whole screen";
    press("F11");
    EXPECT_TRUE(wait_until([&] { return shot().width == width; }, 60)) << "and back";
    press("ctrl+c", "stored frame-");
    press("shift+F12", "stored darkroom-window-");
    end();
    start({GetParam(), scenes_folder + "dungeon.scene.toml", "--size", "320x180", "--paused"});
    const Picture light = shot();
    press("F10", "F10 volumetric: off");
    EXPECT_GT(difference(light, shot()), 0) << "F10 changes the picture";
    press("F10", "F10 volumetric: on");
    EXPECT_EQ(difference(light, shot()), 0) << "and brings it back";
    end();
}

TEST_F(CliViewer, ACapturedFrameDevelopsToThePicture) {
    const std::string scene = scenes_folder + "showcase.scene.toml";
    start({"play", scene, "--size", "320x180", "--fxaa-enabled", "off"});
    press("p", "P pause: on");
    const Picture shown = shot();
    press("ctrl+c", "stored frame-0001.exr");
    leave();
    const Outcome developed =
        run({"develop", path("frame-0001.exr"), "--look", scene, "--fxaa-enabled", "off", "-o", path("developed.png")});
    ASSERT_EQ(developed.code, 0) << developed.err;
    EXPECT_LE(difference(picture("developed.png"), shown), 1.001 / 255);
}

// Of a frame that `render` makes at that time: what moves keeps its motion while the time stands still.
TEST_F(CliViewer, APausedSceneHasItsMotion) {
    const std::string scene = scenes_folder + "showcase.scene.toml";
    const std::vector<std::string> blurred{"--motion-blur-enabled", "on", "--motion-blur-shutter-angle", "360"};
    const auto rendered = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> line{
            "render", scene, "--size",         "320x180", "--fps",  "6", "--samples", "1",
            "--msaa", "4",   "--fxaa-enabled", "off",     "--time", "2", "-o",        path("render.png")};
        line.insert(line.end(), flags.begin(), flags.end());
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture("render.png");
    };
    const Picture sharp = rendered({}), moving = rendered(blurred);
    ASSERT_GT(difference(sharp, moving), 0.02);
    std::vector<std::string> play{"play", scene,      "--size", "320x180", "--fxaa-enabled", "off", "--time",
                                  "2",    "--paused", "--fps",  "6"};
    play.insert(play.end(), blurred.begin(), blurred.end());
    start(play);
    EXPECT_LE(difference(moving, shot()), 1.001 / 255);
    leave();
}

// What an event sets is the moment's: no command takes it into the look, no step of undo takes it back.
TEST_F(CliViewer, EventsDoNotBecomeTheLook) {
    const std::string look = write("my.toml", "[post_process]\nexposure = 1.0\n");
    const std::string events = write("events.toml", "[[event]]\ntime = 0.0\nset = { \"vignette.intensity\" = 1.0 }\n");
    write_grey_frame();
    start({"edit", path("frame.exr"), "--look", look, "--events", events, "--size", "1280x720"});
    const Picture with_event = shot();
    command("exposure.exposure 2");
    press("ctrl+z", "undo: exposure.exposure 2");
    EXPECT_EQ(difference(with_event, shot()), 0);
    command("exposure.exposure 3");
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look), "[post_process]\nexposure = 3.0\n");
    // Both sides of a comparison have it, as if the look itself had it.
    const auto compared = [&](const char* number) {
        press("b", "B compare: on");
        click("view/right");
        press("Up");  // from "off" to "saved"
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        press("space");
        std::this_thread::sleep_for(std::chrono::seconds(2));
        press("shift+F12", fmt::format("stored darkroom-window-{}.png", number));
        leave();
        return picture(fmt::format("darkroom-window-{}.png", number));
    };
    const Picture by_event = compared("0001");
    write("my.toml", "[post_process]\nexposure = 3.0\nvignette_intensity = 1.0\n");
    start({"edit", path("frame.exr"), "--look", look, "--size", "1280x720"});
    const Picture by_look = compared("0002");
    std::size_t others = 0;
    for (std::size_t i = 0; i < by_event.pixels.size(); i += 4)
        if (std::abs(by_event.pixels[i] - by_look.pixels[i]) > 0.05F) ++others;
    EXPECT_LT(others, 20000U) << "of the words beside the picture";
}

// Where an event turns the view, the interface lags behind as in `render`.
TEST_F(CliViewer, TheInterfaceObeysEventsOfTheHead) {
    const std::string events = write("events.toml", "[[event]]\ntime = 1.9\nyaw = 40.0\njump = true\n");
    const std::string hud = write("hud.svg",
                                  "<svg xmlns='http://www.w3.org/2000/svg' width='320' height='180'>"
                                  "<rect x='100' y='60' width='60' height='40' fill='#0f0'/></svg>");
    const auto made = [&](const std::string& command, std::vector<std::string> more, const std::string& file) {
        std::vector<std::string> line{command,          scenes_folder + "dungeon.scene.toml",
                                      "--size",         "320x180",
                                      "--ui",           hud,
                                      "--fxaa-enabled", "off",
                                      "--time",         "2",
                                      "--ui-warp"};
        line.insert(line.end(), more.begin(), more.end());
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture(file);
    };
    const auto rendered = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--samples", "1", "--msaa", "4", "-o", path("render.png")});
        return made("render", more, "render.png");
    };
    const Picture moved = rendered({"--events", events});
    EXPECT_GT(difference(moved, rendered({})), 0.1);
    EXPECT_LE(difference(moved, made("play", {"--events", events, "--screenshot", path("shown.png")}, "shown.png")),
              1.001 / 255);
}

TEST_F(CliViewer, TheConsoleHasItsKeys) {
    write_grey_frame();
    start({"edit", path("frame.exr"), "--size", "1280x720"});
    command("exposure.exposure 2");
    press("grave", "console: on");
    press("ctrl+z");
    press("ctrl+c");
    press("grave", "console: off");
    EXPECT_EQ(count("undo:") + count("stored frame"), 0U) << said();
    press("ctrl+z", "undo: exposure.exposure 2");
    leave();
}

// All of it within one frame: the viewer stands while it is typed.
TEST_F(CliViewer, WhatIsTypedBesideAShortcutIsNotLost) {
    write_grey_frame();
    start({"edit", path("frame.exr"), "--size", "1280x720"});
    press("grave", "console: on");
    ASSERT_EQ(shell("xdotool type another"), 0);
    ASSERT_EQ(shell("xdotool sleep 1"), 0);
    kill(viewer().id(), SIGSTOP);
    ASSERT_EQ(shell("xdotool key ctrl+a type 'exposure.exposure 2'"), 0);
    kill(viewer().id(), SIGCONT);
    ASSERT_EQ(shell("xdotool sleep 1 key Return sleep 1"), 0);
    press("grave", "console: off");
    press("ctrl+z", "undo: exposure.exposure 2");
    leave();
}

// Frames follow each other without a rest: the mouse comes down on the panels before one has seen it there.
TEST_F(CliViewer, ADragThatBeginsOnThePanelsMovesNoCamera) {
    start({"edit", scenes_folder + "dungeon.scene.toml", "--size", "1280x720", "--full-size"});
    const auto [left, top, right, bottom] = place("stack/exposure");
    const Picture before = shot();
    const std::string of = "mousemove --window " + window();
    ASSERT_EQ(shell(fmt::format("xdotool {} 640 300 sleep 1 {} {} {} mousedown 2 sleep 1 mouseup 2", of, of,
                                (left + right) / 2, (top + bottom) / 2)),
              0);
    EXPECT_EQ(difference(before, shot()), 0);
    leave();
}

TEST_F(CliViewer, WalkingChangesTheView) {
    start({"play", scenes_folder + "dungeon.scene.toml", "--size", "320x180"});
    const Picture before = shot();
    ASSERT_EQ(shell("xdotool keydown w sleep 1 keyup w"), 0);
    EXPECT_GT(difference(before, shot()), 0.1);
    leave();
}

TEST_F(CliViewer, AShortcutsKeyDoesNotMoveTheCamera) {
    start({"play", scenes_folder + "dungeon.scene.toml", "--size", "320x180", "--paused"});
    const Picture before = shot();
    ASSERT_EQ(shell("xdotool keydown ctrl keydown s keyup ctrl sleep 1 keyup s"), 0);
    EXPECT_EQ(difference(before, shot()), 0) << "though Control is let go first";
    leave();
}

TEST_F(CliViewer, EditsAreUndoneSavedAndReadAgain) {
    const std::string look = write("my.toml",
                                   "# mine\n[post_process]\nbloom_enabled = true  # it glows\nbloom_intensity = 0.2\n"
                                   "fog_density = 0.05\n");
    start({"edit", scenes_folder + "showcase.scene.toml", "--look", look, "--size", "1280x720"});
    press("p", "P pause: on");
    const Picture before = shot();
    press("F5", "F5 bloom: off");
    EXPECT_GT(difference(before, shot()), 0);
    press("ctrl+z", "undo: F5 bloom: off");
    EXPECT_EQ(difference(before, shot()), 0);
    press("ctrl+shift+z", "redo: F5 bloom: off");
    press("ctrl+s", "saved my.toml");
    EXPECT_EQ(content(look),
              "# mine\n[post_process]\nbloom_enabled = false  # it glows\nbloom_intensity = 0.2\nfog_density = 0.05\n");
    const Picture saved = shot();

    write("my.toml", "[post_process]\nbloom_enabled = true\nbloom_intensity = 0.2\nfog_density = 0.05\n");
    ASSERT_TRUE(wait_for("read my.toml again")) << said() << complained();
    EXPECT_EQ(difference(before, shot()), 0) << "a change on disk is on the screen";
    write("my.toml", "[post_process]\nbloom_intensity = = 3\n");
    EXPECT_TRUE(wait_until([&] { return complained().find("my.toml:2:") != std::string::npos; }, 60)) << complained();
    EXPECT_EQ(difference(before, shot()), 0) << "a broken one leaves the last good state";
    write("my.toml", "[post_process]\nbloom_intensity = 0.3\n");
    EXPECT_TRUE(wait_until([&] { return count("read my.toml again") == 2; }, 60)) << said() << complained();
    write("my.toml", "[post_process]\nbloom_intensity = = 3\n");
    EXPECT_TRUE(wait_until([&] { return complained().find("my.toml:2:") != complained().rfind("my.toml:2:"); }, 60))
        << "the same error is told again: " << complained();
}

TEST_F(CliViewer, SlidersAndTheOrderOfTheStackFollowTheMouse) {
    const std::string text =
        "[[stack]]\neffect = \"bloom\"\nintensity = 0.2  # slid\n\n"
        "[[stack]]\neffect = \"exposure\"\nexposure = 0.4\n\n[[stack]]\neffect = \"tonemap\"\n";
    const std::string look = write("my.toml", text);
    start({"edit", scenes_folder + "showcase.scene.toml", "--look", look, "--size", "1280x720"});
    press("p", "P pause: on");
    const Picture before = shot();
    click("stack/bloom");
    const auto [left, top, right, bottom] = place("bloom.intensity");
    const int middle = (top + bottom) / 2;
    drag({left + (right - left) / 2, middle}, {right - 8, middle});
    const Picture slid = shot();
    EXPECT_GT(difference(before, slid), 0) << "the slider moves the value";
    const std::array<int, 4> first = place("stack/exposure"), last = place("stack/tonemap");
    drag({first[0] + 20, (first[1] + first[3]) / 2}, {last[0] + 20, last[3] - 4});
    EXPECT_TRUE(wait_until([&] { return difference(slid, shot()) > 0; }, 60))
        << "exposure after the curve is another picture";
    press("Escape", "Unsaved changes: press again to quit");
    press("ctrl+s", "saved my.toml");
    const std::string saved = content(look);
    const std::size_t tonemap = saved.find("tonemap"), exposure = saved.find("exposure");
    EXPECT_TRUE(tonemap < exposure && exposure != std::string::npos) << saved;
    EXPECT_NE(saved.find("  # slid"), std::string::npos) << saved;
    EXPECT_EQ(saved.find("intensity = 0.2 "), std::string::npos) << saved;
    leave();
}

TEST_F(CliViewer, ObeysStandardInput) {
    EXPECT_EQ(
        run({"play", scenes_folder + "showcase.scene.toml", "--size", "96x54", "--commands", "--frames", "2"}).code, 0)
        << "the end of what is said is not the window's";
    start({"edit", scenes_folder + "showcase.scene.toml", "--size", "320x180"});
    press("p", "P pause: on");
    const Picture before = shot();
    command("exposure.exposure 3\nexposure.exposure");
    ASSERT_TRUE(wait_for("\"exposure.exposure\" is \"3\"")) << said() << complained();
    EXPECT_GT(difference(before, shot()), 0);
    press("ctrl+z", "undo: exposure.exposure 3");
    command(std::string(600, 'x'));
    EXPECT_TRUE(wait_until([&] { return complained().find("longer than 512 characters") != std::string::npos; }, 60));
    press("ctrl+z", "nothing to undo");
}

TEST_F(CliViewer, SurvivesAStormOfSizes) {
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "320x180", "--fxaa-enabled", "off", "--paused"});
    constexpr int sizes = 200;
    std::mt19937 random(7);
    std::string command = "xdotool";
    for (int i = 0; i < sizes; ++i)
        command += fmt::format(" windowsize {} {} {} sleep 0.02", window(), 64 + random() % 900, 64 + random() % 700);
    ASSERT_EQ(shell(command), 0);
    ASSERT_EQ(shell(fmt::format("xdotool windowsize --sync {} 301 203", window())), 0);
    EXPECT_TRUE(wait_until([&] { return shot().width == 301; }, 60));
    const Outcome rendered = run({"render", scenes_folder + "showcase.scene.toml", "--size", "301x203", "--fps", "60",
                                  "--samples", "1", "--msaa", "4", "--fxaa-enabled", "off", "-o", path("render.png")});
    ASSERT_EQ(rendered.code, 0);
    const Picture expected = picture("render.png");
    // The plan for this very size comes when the size has settled.
    EXPECT_TRUE(wait_until([&] { return difference(expected, shot()) <= 1.001 / 255; }, 60));
    leave();
}

TEST_F(CliViewer, GoesOnAfterItWasMinimised) {
    start({"play", scenes_folder + "showcase.scene.toml", "--size", "320x180"});
    ASSERT_EQ(shell("xdotool windowminimize --sync " + window()), 0);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    ASSERT_TRUE(viewer().is_running());
    ASSERT_EQ(shell(fmt::format("xdotool windowmap --sync {0} windowactivate --sync {0}", window())), 0);
    EXPECT_EQ(shot().width, 320U);
    leave();
}

TEST_F(CliViewer, TakesTheFlagsOfRender) {
    const std::string render = run({"render", "--help-all"}).out;
    for (const char* const mode : {"play", "edit"}) {
        const std::string help = run({mode, "--help-all"}).out;
        std::istringstream lines(render.substr(render.find("The look:")));
        std::size_t flags = 0;
        for (std::string line; std::getline(lines, line);) {
            const std::size_t at = line.find("--");
            if (at != 2) continue;
            const std::string flag = line.substr(at, line.find_first_of(" ,=", at) - at);
            EXPECT_NE(help.find(flag), std::string::npos) << mode << " lacks " << flag;
            ++flags;
        }
        EXPECT_GT(flags, 100U);
    }
}

TEST_F(CliViewer, NeedsADisplay) {
    unsetenv("DISPLAY");
    for (const char* const mode : {"play", "edit"})
        expect_refused({mode, scenes_folder + "dungeon.scene.toml"}, 2, "no window can be opened");
}

TEST_F(CliViewer, RefusesWhatItCannotShow) {
    expect_refused({"play"}, 1, "a scene, a model or a frame is needed");
    expect_refused({"play", scenes_folder + "dungeon.scene.toml", "b.exr"}, 1, "one scene or model at a time");
    expect_refused({"edit", scenes_folder + "dungeon.scene.toml", "--present", "often"}, 1,
                   "vsync, mailbox or immediate");
    expect_refused({"edit", scenes_folder + "dungeon.scene.toml", "--range", "wide"}, 1, "standard or high");
    expect_refused({"play", scenes_folder + "dungeon.scene.toml", "--peak-nits", "5"}, 1, "[100, 10000] cd/m2");
    const std::string scene = scenes_folder + "dungeon.scene.toml";
    // Warnings name the flags of frames.
    expect_refused({"play", source_folder + std::string("/samples/window.exr"), "--eye", "both"}, 1,
                   "--eye both: allowed is one view");
    expect_refused({"edit", source_folder + std::string("/samples/window.exr"), "--normals-space", "eye"}, 1,
                   "allowed is world, view");
    expect_refused({"play", scene, "--frame-time", "0"}, 1, "--frame-time = 0: allowed is [0.1, 1000] ms");
    expect_refused({"play", scene, "--frame-time", "16", "--full-size"}, 1, "--full-size draws every pixel");
    expect_refused({"play", scene, "--frame-time", "16", "--frames", "2"}, 1, "frames that are counted");
    expect_refused({"edit", write("frame.exr", ""), "--frame-time", "16"}, 1,
                   "--frame-time: stored frames have the lines they have");
    expect_refused({"edit", path("missing.exr")}, 1, "missing.exr");
    expect_refused({"edit", scenes_folder + "dungeon.scene.toml", "--screenshot", path("none/a.png")}, 1, "none");
}

}  // namespace

}  // namespace darkroom::test
