// SPDX-License-Identifier: MIT
#pragma once
// The flags that say what is in the file of a frame where the file does not: names of layers, the camera,
// the colour space.

#include <darkroom/result.hpp>
#include <string>
#include <vector>

#include "flags.hpp"
#include "image/frame/frame_file.hpp"

namespace app {

/// --map, --eye, --overscan, --depth-scale, --depth-inverse, --fov, --camera, --normals-space, --up, --input-space.
class FrameFlags {
  public:
    /// `is_window`: of a command without --ocio, whose --fov is among the flags of scenes.
    void add_to(CommandFlags command, bool is_window = false);
    /// `configuration`: that --input-space names a space of; empty: none. `eye`: one of eyes().
    [[nodiscard]] darkroom::Result<darkroom::FrameOptions> options(const std::string& configuration,
                                                                   const std::string& eye) const;
    /// The views that are asked for, of which "both" are "left" and "right"; an empty one: that of the file.
    [[nodiscard]] std::vector<std::string> eyes() const;

    bool keeps_overscan = false;

    [[nodiscard]] bool has_input_space() const { return !input_space_.empty(); }
    [[nodiscard]] const std::string& input_space() const { return input_space_; }

  private:
    std::vector<std::string> maps_;
    std::string camera_, normals_space_, up_, input_space_, eye_;
    bool is_depth_inverse_ = false;
    NumberFlag depth_scale_{"--depth-scale", {.least = 0, .most = 1e9, .is_open = true}};
    NumberFlag fov_{"--fov", {.least = 0, .most = 180, .is_open = true, .unit = "deg"}};
};

}  // namespace app
