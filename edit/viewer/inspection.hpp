// SPDX-License-Identifier: MIT
#pragma once
// What is measured of the frames that a viewer shows: the pixel that was chosen, and the picture that scopes draw.

#include <darkroom/device.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "develop/inspect/inspector.hpp"
#include "develop/readback.hpp"
#include "panels/show/scopes.hpp"
#include "viewer/source/look_view.hpp"
#include "window/presenter.hpp"

namespace app {

class FrameInspection {
  public:
    /// Of this pixel, behind the record of its frame; nothing: none is chosen. `number`: the presenter's of the frame.
    [[nodiscard]] darkroom::Result<> record_pixel(darkroom::Device& device, VkCommandBuffer commands,
                                                  std::uint64_t number, LookView& look, const darkroom::Frame& frame,
                                                  std::optional<VkOffset2D> pixel);
    /// Of the picture of this look. `is_another`: than the last one that was recorded; else that one's scopes stand.
    [[nodiscard]] darkroom::Result<> record_scopes(darkroom::Device& device,
                                                   const darkroom::window::PresentFrame& frame, const LookView& look,
                                                   bool is_another);
    void hide_scopes() { has_scopes_ = false; }
    /// Takes what has finished. `measure` is given a picture for scopes. True: something new is known.
    bool finish(const darkroom::window::Presenter& presenter,
                const std::function<void(const darkroom::panels::ScopePicture&)>& measure);
    [[nodiscard]] const darkroom::Inspection* pixel() const { return pixel_ ? &*pixel_ : nullptr; }

  private:
    struct Pending {
        std::uint64_t frame = 0, recording = 0;
    };
    std::unique_ptr<darkroom::Inspector> inspector_;
    std::deque<Pending> pending_;
    std::optional<darkroom::Inspection> pixel_;
    darkroom::gpu::Image scope_image_;
    std::optional<darkroom::Readback> scope_read_;
    std::optional<std::uint64_t> scope_frame_;  ///< whose copy is on its way
    bool has_scopes_ = false;                   ///< since they were shown
};

}  // namespace app
