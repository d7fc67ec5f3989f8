// SPDX-License-Identifier: MIT
#pragma once
// A window of the desktop by GLFW, and what its user does with keys and mouse. One a process, on the main thread.

#include <vulkan/vulkan.h>

#include <array>
#include <darkroom/result.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

namespace darkroom::window {

struct WindowDesc {
    std::string title;
    VkExtent2D size{1280, 720};  ///< of what is drawn, in pixels where the desktop does not scale
    bool is_fullscreen = false;
};

struct KeyPress {
    int key = 0;        ///< GLFW_KEY_...
    int modifiers = 0;  ///< GLFW_MOD_...
};

class Window {
  public:
    /// A machine error if there is no display, or if it cannot show Vulkan.
    [[nodiscard]] static Result<Window> create(const WindowDesc& desc);
    Window(Window&&) noexcept;
    Window& operator=(Window&&) noexcept;
    ~Window();

    /// What an instance needs to make surfaces for it.
    [[nodiscard]] std::span<const char* const> instance_extensions() const;
    [[nodiscard]] Result<VkSurfaceKHR> make_surface(VkInstance instance) const;

    /// Takes what has happened since the last call.
    void poll();
    /// The same, but sleeps until something happens, at most so many seconds: while there is nothing to draw.
    void wait(double seconds);
    [[nodiscard]] bool is_closing() const;
    /// Takes back that its user closed it.
    void stay_open();

    /// Of what is drawn, in pixels; (0, 0): it is minimised.
    [[nodiscard]] VkExtent2D extent() const;
    /// Of the desktop: 2 where text is to be twice as large.
    [[nodiscard]] float scale() const;
    [[nodiscard]] bool is_fullscreen() const;
    void set_fullscreen(bool fullscreen);
    void set_title(const std::string& title);
    /// Hides the cursor and lets it move without end.
    void capture_cursor(bool is_captured);
    [[nodiscard]] bool is_cursor_captured() const;

    /// Has anything happened since this was last asked, or is a key or a button held?
    [[nodiscard]] bool take_news();
    /// Keys that went down since the last poll, in order.
    [[nodiscard]] const std::vector<KeyPress>& pressed() const;
    [[nodiscard]] bool is_down(int key) const;
    /// Is it down by itself? A key of a shortcut is not, even after Control has been let go.
    [[nodiscard]] bool is_held(int key) const;
    [[nodiscard]] bool is_button_down(int button) const;
    /// Where the mouse is, in pixels of the window from its top left corner.
    [[nodiscard]] std::array<double, 2> mouse() const;
    /// How far the mouse went since the last poll, in pixels, and its wheel, in notches.
    [[nodiscard]] std::array<double, 2> mouse_moved() const;
    [[nodiscard]] double wheel() const;

    [[nodiscard]] GLFWwindow* handle() const;

  private:
    struct State;
    explicit Window(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace darkroom::window
