// SPDX-License-Identifier: MIT
#pragma once
// Dear ImGui in a window of ours: its context, what the window's user does, and its lists on the picture.

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "window/damage.hpp"
#include "window/gui_pass.hpp"
#include "window/presenter.hpp"
#include "window/window.hpp"

namespace app {

class Gui {
  public:
    /// The window's callbacks are taken over; those it had are still called.
    [[nodiscard]] static darkroom::Result<std::unique_ptr<Gui>> create(darkroom::gpu::Context& context,
                                                                       darkroom::window::Window& window,
                                                                       const darkroom::window::GuiPass::Desc& desc);
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;
    ~Gui();

    /// Windows of the interface may be made from now on, up to draw(). `scale`: of text and spaces.
    [[nodiscard]] darkroom::Result<> begin(float scale);
    /// Ends what begin() began, and draws of it what the frame's image does not have yet.
    [[nodiscard]] darkroom::Result<> draw(const darkroom::window::PresentFrame& frame);
    /// Is somebody typing, or pointing at a panel?
    [[nodiscard]] bool wants_keys() const;
    [[nodiscard]] bool wants_mouse() const;
    /// Has this character been typed since the last frame, into no field?
    [[nodiscard]] bool has_typed(unsigned character) const;
    /// Is there something that Esc closes?
    [[nodiscard]] bool has_popup() const { return has_popup_; }

  private:
    Gui(darkroom::gpu::Context& context, darkroom::window::Window& window) : context_(context), window_(window) {}
    void hold_short_presses();
    /// Of a frame, where its image differs from what these lists draw.
    [[nodiscard]] std::vector<VkRect2D> parts_of(const darkroom::window::PresentFrame& frame, const ImDrawData& lists);

    darkroom::gpu::Context& context_;
    darkroom::window::Window& window_;
    std::vector<int> held_;        ///< keys that went down and up within a frame
    std::vector<unsigned> later_;  ///< characters that were typed beside a shortcut
    std::optional<darkroom::window::GuiPass> pass_;
    struct Changed {
        std::uint64_t frame = 0;
        std::vector<VkRect2D> parts;
    };
    darkroom::window::Damage damage_;
    std::deque<Changed> changed_;  ///< by the last frames
    float scale_ = 0;
    bool is_attached_ = false, has_popup_ = false;
};

}  // namespace app
