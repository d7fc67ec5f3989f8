// SPDX-License-Identifier: MIT
#pragma once
// play and edit: frames of a scene or of files, live, through a look, in a window.

#include <darkroom/look.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/document.hpp"
#include "programs/darkroom/run/timeline.hpp"
#include "viewer/source/frame_source.hpp"
#include "viewer/source/scene_source.hpp"
#include "window/presenter.hpp"
#include "window/window.hpp"

namespace app {

/// All that flags and files say, before there is a window.
struct ViewerJob {
    bool is_edit = false;
    std::filesystem::path scene;                 ///< or a model; empty: frames
    std::vector<darkroom::NumberedFile> frames;  ///< of files
    SceneSource::Desc scene_desc;
    FrameSource::Desc frame_desc;
    darkroom::scene::OrbitOverride orbit;
    std::optional<double> time;  ///< of the first frame; else the scene's

    std::optional<darkroom::edit::LookDocument> document;  ///< always given
    darkroom::LookOptions look_options;
    Timeline timeline;
    bool is_off = false;  ///< it begins without post-processing
    darkroom::KernelStage kernels = darkroom::KernelStage::Auto;
    bool fuse = true;

    std::string device;  ///< as in DeviceDesc
    darkroom::window::WindowDesc window;
    darkroom::window::Presentation presentation = darkroom::window::Presentation::Vsync;
    darkroom::window::DynamicRange range = darkroom::window::DynamicRange::Standard;
    float peak_nits = 1000;     ///< of a display of high range
    bool turns = false;         ///< the camera goes round by itself
    bool is_paused = false;     ///< the time stands still at first
    bool is_full_size = false;  ///< also while something moves, however long frames take
    /// Seconds that the device may take for a frame: a scene is drawn with fewer lines where it needs more.
    std::optional<double> frame_time;
    bool obeys_input = false;  ///< lines of standard input are the console's commands

    /// For tests and pictures: so many frames, `step` seconds apart, then it ends.
    std::optional<std::uint64_t> frames_to_show;
    double step = 1.0 / 60;
    std::filesystem::path screenshot, window_screenshot;  ///< of the last one
};

/// Runs until its user leaves. Returns the exit code; errors have been told.
[[nodiscard]] int run_viewer(ViewerJob job);

}  // namespace app
