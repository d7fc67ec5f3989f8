// SPDX-License-Identifier: MIT
#pragma once
// What keys do in a viewer: one table, which `--help-keys` prints and the window obeys.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "window/window.hpp"

namespace app {

enum class KeyAction : std::uint8_t {
    DebugView,
    Shadows,
    Effect,  ///< those that a description gives this key
    All,
    Fullscreen,
    Screenshot,
    WindowScreenshot,
    Capture,
    Console,
    Panels,
    Save,
    Undo,
    Redo,
    Pause,
    StepBack,
    StepForth,
    ResetCamera,
    FrameAll,
    CameraKind,
    Compare,
    KeySheet,
    Leave,
};

struct Key {
    int key = 0;
    int modifiers = 0;
    KeyAction action{};
    std::string_view shown;  ///< "Ctrl+S"
    std::string_view doc;
    bool is_for_play = true, is_for_edit = true;
};

/// All keys that are pressed once, without those of effects.
[[nodiscard]] std::span<const Key> keys();
/// What a press means in this mode; nothing: nothing.
[[nodiscard]] std::optional<KeyAction> action_of(const darkroom::window::KeyPress& press, bool is_edit);
/// The number of a key F1 .. F12; 0: it is none.
[[nodiscard]] std::uint32_t function_key(int key);
/// What a key or a button of the mouse does, for people.
struct KeyLine {
    std::string shown;
    std::string_view doc;
    bool is_for_play = true, is_for_edit = true;
};
[[nodiscard]] std::vector<KeyLine> key_lines();
/// All of it as text, a line a key.
[[nodiscard]] std::string keys_text();

}  // namespace app
