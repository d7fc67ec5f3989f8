// SPDX-License-Identifier: MIT
#include "window/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace darkroom::window {

namespace {

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason was given";
}

/// GLFW 3.4 asks for a Wayland display even where none is named, and what it asks prints an error of its own.
void choose_platform() {
#ifdef GLFW_PLATFORM
    const auto is_set = [](const char* name) {
        const char* const value = std::getenv(name);
        return value != nullptr && *value != 0;
    };
    if (is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET"))
        glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
}

/// The library is up as long as this exists.
struct Library {
    Library() = default;
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
    ~Library() {
        if (is_up) glfwTerminate();
    }
    bool is_up = false;
};

struct DestroyWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

}  // namespace

struct Window::State {
    Library library;
    std::unique_ptr<GLFWwindow, DestroyWindow> window;
    std::span<const char* const> extensions;
    std::vector<KeyPress> pressed;
    std::array<double, 2> cursor{}, moved{};
    double wheel = 0;
    bool is_captured = false, is_news = true;
    std::set<int> held;             ///< keys; buttons as -1 and below
    std::set<int> shortcuts;        ///< of these, keys that went down with Control, Alt or Super
    std::array<int, 4> windowed{};  ///< place and size before it became fullscreen

    void begin() {
        pressed.clear();
        wheel = 0;
    }
    void end() {
        std::array<double, 2> now{};
        glfwGetCursorPos(window.get(), &now[0], &now[1]);
        moved = {now[0] - cursor[0], now[1] - cursor[1]};
        is_news = is_news || moved[0] != 0 || moved[1] != 0;
        cursor = now;
    }
    void hold(int what, int action) {
        is_news = true;
        action == GLFW_RELEASE ? static_cast<void>(held.erase(what)) : static_cast<void>(held.insert(what));
    }
    static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }
};

Window::Window(std::unique_ptr<State> state) : state_(std::move(state)) {}
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;
Window::~Window() = default;

Result<Window> Window::create(const WindowDesc& desc) {
    auto state = std::make_unique<State>();
    choose_platform();
    if (glfwInit() != GLFW_TRUE) return machine_error(fmt::format("no window can be opened: {}", last_error()));
    state->library.is_up = true;
    std::uint32_t count = 0;
    const char** const names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) return machine_error(fmt::format("no window can show Vulkan: {}", last_error()));
    state->extensions = {names, count};
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_TRUE);
    state->window.reset(glfwCreateWindow(static_cast<int>(desc.size.width), static_cast<int>(desc.size.height),
                                         desc.title.c_str(), nullptr, nullptr));
    if (!state->window) return machine_error(fmt::format("no window can be opened: {}", last_error()));
    GLFWwindow* const window = state->window.get();
    glfwSetWindowUserPointer(window, state.get());
    glfwSetWindowSizeLimits(window, 64, 64, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetKeyCallback(window, [](GLFWwindow* of, int key, int, int action, int modifiers) {
        State& own = State::of(of);
        if (action == GLFW_PRESS) own.pressed.push_back({key, modifiers});
        own.hold(key, action);
        if (action == GLFW_RELEASE) own.shortcuts.erase(key);
        if (action == GLFW_PRESS && (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0)
            own.shortcuts.insert(key);
    });
    glfwSetMouseButtonCallback(
        window, [](GLFWwindow* of, int button, int action, int) { State::of(of).hold(-1 - button, action); });
    glfwSetScrollCallback(window, [](GLFWwindow* of, double, double y) {
        State::of(of).wheel += y;
        State::of(of).is_news = true;
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* of) { State::of(of).is_news = true; });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* of, int, int) { State::of(of).is_news = true; });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* of) { State::of(of).is_news = true; });
    // The lists of ImGui call these in turn.
    glfwSetWindowFocusCallback(window, [](GLFWwindow* of, int) { State::of(of).is_news = true; });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* of, int) { State::of(of).is_news = true; });
    glfwSetCharCallback(window, [](GLFWwindow* of, unsigned) { State::of(of).is_news = true; });
    glfwGetCursorPos(window, &state->cursor[0], &state->cursor[1]);
    Window out(std::move(state));
    if (desc.is_fullscreen) out.set_fullscreen(true);
    return out;
}

std::span<const char* const> Window::instance_extensions() const { return state_->extensions; }

Result<VkSurfaceKHR> Window::make_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, handle(), nullptr, &surface) != VK_SUCCESS)
        return machine_error(fmt::format("making a surface for the window failed: {}", last_error()));
    return surface;
}

void Window::poll() {
    state_->begin();
    glfwPollEvents();
    state_->end();
}

void Window::wait(double seconds) {
    state_->begin();
    glfwWaitEventsTimeout(seconds);
    state_->end();
}

bool Window::is_closing() const { return glfwWindowShouldClose(handle()) != 0; }
void Window::stay_open() { glfwSetWindowShouldClose(handle(), GLFW_FALSE); }

VkExtent2D Window::extent() const {
    if (glfwGetWindowAttrib(handle(), GLFW_ICONIFIED) != 0) return {0, 0};
    int width = 0, height = 0;
    glfwGetFramebufferSize(handle(), &width, &height);
    return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

float Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(handle(), &x, &y);
    return std::max(x, y);
}

bool Window::is_fullscreen() const { return glfwGetWindowMonitor(handle()) != nullptr; }

void Window::set_fullscreen(bool fullscreen) {
    auto& [x, y, width, height] = state_->windowed;
    if (fullscreen == is_fullscreen()) return;
    if (!fullscreen) {
        glfwSetWindowMonitor(handle(), nullptr, x, y, width, height, GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    glfwGetWindowPos(handle(), &x, &y);
    glfwGetWindowSize(handle(), &width, &height);
    glfwSetWindowMonitor(handle(), monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(handle(), title.c_str()); }

void Window::capture_cursor(bool is_captured) {
    if (is_captured == state_->is_captured) return;
    state_->is_captured = is_captured;
    glfwSetInputMode(handle(), GLFW_CURSOR, is_captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    // Its next place does not count as a movement.
    glfwGetCursorPos(handle(), &state_->cursor[0], &state_->cursor[1]);
}

bool Window::is_cursor_captured() const { return state_->is_captured; }
bool Window::take_news() { return std::exchange(state_->is_news, false) || !state_->held.empty(); }
const std::vector<KeyPress>& Window::pressed() const { return state_->pressed; }
bool Window::is_down(int key) const { return glfwGetKey(handle(), key) == GLFW_PRESS; }
bool Window::is_held(int key) const { return is_down(key) && !state_->shortcuts.contains(key); }
bool Window::is_button_down(int button) const { return glfwGetMouseButton(handle(), button) == GLFW_PRESS; }
std::array<double, 2> Window::mouse() const {
    // Places are of the desktop's unit, which Wayland has several pixels for.
    int width = 0, height = 0;
    glfwGetWindowSize(handle(), &width, &height);
    const VkExtent2D pixels = extent();
    if (width <= 0 || height <= 0) return state_->cursor;
    return {state_->cursor[0] * pixels.width / width, state_->cursor[1] * pixels.height / height};
}
std::array<double, 2> Window::mouse_moved() const { return state_->moved; }
double Window::wheel() const { return state_->wheel; }
GLFWwindow* Window::handle() const { return state_->window.get(); }

}  // namespace darkroom::window
