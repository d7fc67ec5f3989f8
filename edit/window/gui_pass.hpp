// SPDX-License-Identifier: MIT
#pragma once
// Draws the lists of Dear ImGui, and the panes in them (window/pane.hpp), by dynamic rendering. It makes neither the
// lists nor the images.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>

#include "core/try.hpp"
#include "window/pane.hpp"

struct ImDrawData;
struct ImFontAtlas;

namespace darkroom::gpu {
class Context;
}

namespace darkroom::window {

class GuiPass {
  public:
    /// Different panes in one frame's lists.
    static constexpr std::uint32_t max_panes = 256;

    struct Desc {
        VkFormat format = VK_FORMAT_UNDEFINED;  ///< of the colour attachment; an sRGB one is given decoded colours
        /// What it holds. White of the interface has 203 cd/m2, and pictures of light go on to the peak.
        ColorState color = srgb_color;
        std::uint32_t slots = 2;  ///< recordings that may be unfinished
    };
    /// Uploads the atlas, which is built if it was not. Errors: VkResult.
    [[nodiscard]] static Result<GuiPass> create(gpu::Context& context, const Desc& desc, ImFontAtlas& atlas);
    /// The atlas has changed, for a screen with other pixels, say. No recorded frame may be waiting to be submitted;
    /// waits for the context's queue.
    Result<> upload_fonts(ImFontAtlas& atlas);

    /// Draws inside a rendering instance over one colour attachment of the format, as large as
    /// DisplaySize * FramebufferScale. Slot: no recording with it is unfinished. A texture is a Pane, or null or the
    /// atlas's for the fonts. Errors: more panes than max_panes, VkResult.
    Result<> record(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot);
    /// The same in parts, each in a rendering instance of its own: begin() once, then what lies within each part.
    Result<> begin(const ImDrawData& data, std::uint32_t slot);
    Result<> record_part(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot, const VkRect2D& part);

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace darkroom::window
