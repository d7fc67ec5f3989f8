// SPDX-License-Identifier: MIT
#pragma once
// What a viewer stores: its picture, its window, the raw frame. Copies are recorded behind what makes them, and written
// to files once their frame has finished, on threads of their own.

#include <darkroom/device.hpp>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include "develop/readback.hpp"
#include "viewer/source/look_view.hpp"
#include "window/presenter.hpp"

namespace app {

class Store {
  public:
    /// What came of a file.
    struct Said {
        std::string line;
        bool is_error = false;
    };
    using Start = std::function<std::future<Said>(std::function<Said()>)>;

    // Of the next frame, in the working folder or in this file.
    void want_picture();
    void want_window();
    void want_frame();
    void want(const std::filesystem::path& picture, const std::filesystem::path& window);
    [[nodiscard]] bool is_wanted() const { return wants_picture() || wants_window() || wants_frame(); }
    [[nodiscard]] bool wants_picture() const { return !pictures_.empty(); }
    [[nodiscard]] bool wants_window() const { return !window_.empty(); }
    [[nodiscard]] bool wants_frame() const { return !frame_.empty(); }

    /// Records the copies. `has_floats`: pictures are of high range.
    [[nodiscard]] darkroom::Result<> record_picture(const darkroom::Device& device,
                                                    const darkroom::window::PresentFrame& frame, const LookView& view,
                                                    bool has_floats);
    [[nodiscard]] darkroom::Result<> record_frame(const darkroom::Device& device,
                                                  const darkroom::window::PresentFrame& frame,
                                                  const darkroom::Frame& of, const darkroom::Frame& as_stored);
    [[nodiscard]] darkroom::Result<> record_window(const darkroom::Device& device,
                                                   const darkroom::window::Presenter& presenter,
                                                   const darkroom::window::PresentFrame& frame);
    /// Begins to write what has finished. What is written by now, or, if it `waits`, all.
    [[nodiscard]] std::vector<Said> finish(const darkroom::window::Presenter& presenter, const Start& start,
                                           bool waits);
    /// Copies that are under way are lost with their device.
    void forget() { copies_.clear(); }

  private:
    struct Copy {
        std::uint64_t frame = 0;
        std::filesystem::path path;
        std::optional<darkroom::Readback> picture;
        std::optional<darkroom::FrameReadback> layers;
        darkroom::Frame of{};
        darkroom::window::PaneTransfer transfer{};  ///< of the picture
        bool has_floats = false;                    ///< likewise
    };
    std::vector<std::filesystem::path> pictures_;  ///< as often as it was asked for
    std::filesystem::path window_, frame_;
    std::deque<Copy> copies_;
    std::deque<std::future<Said>> writing_;
};

}  // namespace app
