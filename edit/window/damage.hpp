// SPDX-License-Identifier: MIT
#pragma once
// Where an interface differs from that of the frame before, by the lists of Dear ImGui: a few rectangles that are drawn
// anew over what was there. It draws nothing, and knows nothing of pictures: a pane counts as another one in each
// frame.

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <vector>

struct ImDrawData;

namespace darkroom::window {

/// So many more would be drawn again and again.
inline constexpr std::size_t max_damaged_parts = 4;

/// Adds a rectangle to few that cover all that was added.
void add_part(std::vector<VkRect2D>& parts, const VkRect2D& part);

class Damage {
  public:
    Damage();
    Damage(Damage&&) noexcept;
    Damage& operator=(Damage&&) noexcept;
    ~Damage();

    /// What these lists change since the last call, in pixels of the target; all of it at first and at another size.
    /// `fonts`: the texture of the atlas.
    [[nodiscard]] std::vector<VkRect2D> take(const ImDrawData& data, const void* fonts);

  private:
    struct List;
    std::vector<List> before_;
    std::array<float, 6> display_{};  ///< place, size and scale
};

}  // namespace darkroom::window
