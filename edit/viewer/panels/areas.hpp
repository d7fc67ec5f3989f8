// SPDX-License-Identifier: MIT
#pragma once
// What the files that draw the panels of `edit` share.

#include <imgui.h>
#include <vulkan/vulkan.h>

#include <cstdint>

namespace app {

/// A window of Dear ImGui that fills this area and stays there.
void begin_area(const char* name, const VkRect2D& area, ImGuiWindowFlags more = 0);
/// Of the last item, while the mouse is over it.
void tip(const char* text);
[[nodiscard]] float checkbox_width(const char* label);

/// Items side by side, as many as a line has room for.
class Flow {
  public:
    /// Before an item of this width.
    void next(float width);
    [[nodiscard]] std::uint32_t rows() const { return rows_; }

  private:
    std::uint32_t rows_ = 0;
};

}  // namespace app
