// SPDX-License-Identifier: MIT
#include "view_flags.hpp"

#include <fmt/format.h>

#include <memory>

#include "programs/darkroom/commands.hpp"

namespace app {

namespace {

Command add_view(CommandFlags program, const char* name, const char* doc, bool is_edit,
                 std::span<const darkroom::LookEntry> named, const View& view) {
    const CommandFlags command = program.add_command(name, doc);
    command.examples(
        fmt::format("darkroom {0} scene.toml\n"
                    "darkroom {0} scene.toml --look my.toml --fullscreen\n"
                    "darkroom {0} 'shot.####.exr' --fps 24",
                    name));
    const auto flags = std::make_shared<ViewFlags>();
    flags->add_to(command, is_edit, named);
    return {command, [flags, view] { return view(*flags); }};
}

}  // namespace

std::vector<Command> add_view(CommandFlags program, std::span<const darkroom::LookEntry> named, const View& view) {
    return {
        add_view(program, "play", "Walks through a scene, live, in a window", false, named, view),
        add_view(program, "edit", "Shows a scene or frames, live, with every parameter at hand", true, named, view)};
}

CommandRow view_command() {
    return {.names = {"play", "edit"}, .place = 30, .add = [](const CommandHost& host) {
                return add_view(host.program, host.named,
                                [become = host.become](const ViewFlags&) { return become("darkroom_viewer"); });
            }};
}

namespace {

constexpr VkExtent2D play_extent{1280, 720}, edit_extent{1600, 900};

}  // namespace

void ViewFlags::add_to(CommandFlags command, bool edits, std::span<const darkroom::LookEntry> named) {
    is_edit = edits;
    command
        .add_option(
            "INPUT", inputs,
            "A scene (.toml), a model (.glb, .gltf), a frame or picture, or a sequence: shot.####.exr; a look "
            "(.toml, or the name of one that ships) is shown on a frame that ships, or on what stands beside it")
        .names_look();
    const std::string group = "The window";
    command.add_flag("--fullscreen", is_fullscreen, "Fills the screen").group(group);
    command
        .add_option(
            "--present", presentation,
            "vsync waits for the display, mailbox shows the newest frame at a refresh, immediate waits for nothing")
        .type_name("vsync|mailbox|immediate")
        .capture_default()
        .group(group);
    command.add_option("--range", range, "high shows light beyond white where the display can; --frames takes standard")
        .type_name("standard|high")
        .capture_default()
        .group(group);
    peak.add_to(command, "Peak luminance of a display of high range")
        .type_name("CD/M2")
        .default_str("1000")
        .group(group);
    frames.add_to(command, "Shows so many frames, 1 / fps seconds apart, and ends").type_name("N").group(group);
    frames_per_second.add_to(command, "Frames a second, for --frames and for a sequence")
        .type_name("N")
        .default_str(fmt::format("{}", usual_frames_per_second))
        .group(group);
    time.add_to(command, "The scene's time at the first frame, default: what the scene says, or 0")
        .type_name("S")
        .group(group);
    command.add_flag("--paused", is_paused, "The time stands still until P is pressed").group(group);
    command
        .add_flag(
            "--full-size", is_full_size,
            "Draws every pixel also while something moves; else a half or a quarter each way where frames take long")
        .group(group);
    frame_time
        .add_to(command, "Draws a scene with fewer lines, down to a third, where the device takes longer for a frame")
        .type_name("MS")
        .group(group);
    command.add_option("--screenshot", screenshot, "Stores the last frame's picture, and ends (--frames 1)")
        .type_name("OUT")
        .group(group);
    command
        .add_option("--window-screenshot", window_screenshot,
                    "Stores the window's last picture, with all that lies over it")
        .type_name("OUT")
        .group(group);
    command
        .add_flag("--commands", obeys_input,
                  "Obeys the console's commands from standard input, a line each, and prints what they answer")
        .group(group);
    command.add_flag("--help-keys", asks_for_keys, "Prints what keys and mouse do").group(group);
    if (is_edit) command.add_flag("--auto-orbit", turns, "The camera goes round by itself").group(group);
    frame.add_to(command, true);
    drawn.add_to(command, is_edit ? edit_extent : play_extent, usual_msaa, group);
    device.add_to(command);
    look.add_to(command, true, named);
}

}  // namespace app
