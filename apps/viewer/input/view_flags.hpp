// SPDX-License-Identifier: MIT
#pragma once
// The flags of `play` and `edit`: what is shown, how the window is, and all of the look.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/darkroom/flags/device_flags.hpp"
#include "apps/darkroom/flags/flags.hpp"
#include "apps/darkroom/flags/look_flags.hpp"
#include "apps/darkroom/flags/number_flag.hpp"
#include "apps/darkroom/render/scene_flags.hpp"
#include "apps/viewer/viewer.hpp"

namespace app {

class ViewFlags {
  public:
    void add_to(CommandFlags command, bool is_edit, std::span<const darkroom::LookEntry> named);
    [[nodiscard]] darkroom::Result<ViewerJob> job() const;
    [[nodiscard]] bool asks_for_keys() const { return asks_for_keys_; }

  private:
    /// What is named: files to be shown, and the look that they are shown through.
    struct Named {
        std::vector<std::string> inputs;
        std::filesystem::path look;
    };
    [[nodiscard]] darkroom::Result<Named> named() const;
    [[nodiscard]] darkroom::Result<> read_subject(ViewerJob& job, const std::vector<std::string>& inputs) const;
    [[nodiscard]] darkroom::Result<> read_look(ViewerJob& job, std::filesystem::path path) const;
    [[nodiscard]] darkroom::Result<> read_window(ViewerJob& job) const;

    bool is_edit_ = false;
    std::vector<std::string> inputs_;
    SceneFlags drawn_;
    LookFlags look_;
    DeviceFlags device_;
    std::string presentation_ = "vsync", range_ = "high", screenshot_, window_screenshot_, camera_;
    std::vector<std::string> maps_;
    bool is_fullscreen_ = false, turns_ = false, is_paused_ = false, is_full_size_ = false, asks_for_keys_ = false,
         obeys_input_ = false;
    NumberFlag time_{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames_{"--frames", {.least = 1, .most = 1e9, .is_whole = true}};
    NumberFlag peak_{"--peak-nits", {.least = 100, .most = 10000, .unit = "cd/m2"}};
    NumberFlag frames_per_second_{"--fps", {.least = 0.001, .most = 1e6}};
};

}  // namespace app
