// SPDX-License-Identifier: MIT
#pragma once
// The picture in the window: where it lies, how much of it is seen, and how its numbers are shown.

#include <vulkan/vulkan.h>

#include <optional>
#include <string>

#include "window/pane.hpp"

namespace app {

class PictureView {
  public:
    struct Shown {
        darkroom::window::PaneView first;
        std::optional<darkroom::window::PaneView> second;  ///< right of the divider
        std::string first_name, second_name;               ///< where there are two
        VkExtent2D extent{};                               ///< of the picture, in pixels
        std::optional<VkOffset2D> marked;                  ///< a pixel that stands out
        bool can_zoom = false;                             ///< else the mouse is the camera's
    };
    /// Under everything else of the interface.
    void draw(const Shown& shown, const VkRect2D& area);

    [[nodiscard]] darkroom::window::Pane& pane() { return pane_; }
    /// The picture's pixel under the mouse; nothing: it is elsewhere, or over a panel.
    [[nodiscard]] std::optional<VkOffset2D> pointed() const { return pointed_; }
    /// Is the divider or the picture being dragged?
    [[nodiscard]] bool is_busy() const { return is_dragging_ || is_panning_; }
    /// All of it, or a pixel of the picture on one of the window.
    void fit() { zoom_ = 0; }
    void set_zoom(float zoom) { zoom_ = zoom; }
    [[nodiscard]] float zoom() const { return zoom_; }  ///< 0: it is fitted

  private:
    darkroom::window::Pane pane_;
    float zoom_ = 0;
    float center_x_ = 0.5F, center_y_ = 0.5F;  ///< of the picture, in the middle of the area
    void draw_names(const Shown& shown, const VkRect2D& area, float divider) const;

    bool is_dragging_ = false, is_panning_ = false;
    std::optional<VkOffset2D> pointed_;
};

}  // namespace app
