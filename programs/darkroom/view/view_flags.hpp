// SPDX-License-Identifier: MIT
#pragma once
// The flags of `play` and `edit`: what is shown, how the window is, and all of the look.

#include <span>
#include <string>
#include <vector>

#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/frame_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/render/scene_flags.hpp"

namespace app {

inline constexpr double usual_frames_per_second = 60;

struct ViewFlags {
    void add_to(CommandFlags command, bool edits, std::span<const darkroom::LookEntry> named);

    bool is_edit = false;
    std::vector<std::string> inputs;
    SceneFlags drawn;
    FrameFlags frame;
    LookFlags look;
    DeviceFlags device;
    std::string presentation = "vsync", range = "high", screenshot, window_screenshot;
    bool is_fullscreen = false, turns = false, is_paused = false, is_full_size = false, asks_for_keys = false,
         obeys_input = false;
    NumberFlag time{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames{"--frames", {.least = 1, .most = 1e9, .is_whole = true}};
    NumberFlag peak{"--peak-nits", {.least = 100, .most = 10000, .unit = "cd/m2"}};
    NumberFlag frame_time{"--frame-time", {.least = 0.1, .most = 1000, .unit = "ms"}};
    NumberFlag frames_per_second{"--fps", {.least = 0.001, .most = 1e6, .is_rate = true}};
};

/// Shows what the flags ask for. Returns the exit code.
using View = std::function<int(const ViewFlags&)>;
/// play and edit.
[[nodiscard]] std::vector<Command> add_view(CommandFlags program, std::span<const darkroom::LookEntry> named,
                                            const View& view);

}  // namespace app
