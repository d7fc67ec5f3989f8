// SPDX-License-Identifier: MIT
#include "keys.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <array>
#include <darkroom/effect.hpp>

namespace app {

namespace {

constexpr int relevant = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;

constexpr std::array table{
    Key{GLFW_KEY_F1, 0, KeyAction::DebugView, "F1", "the next debug view: wireframe, normals, depth ..."},
    Key{GLFW_KEY_F4, 0, KeyAction::Shadows, "F4", "shadows"},
    Key{GLFW_KEY_F6, 0, KeyAction::All, "F6",
        "all post-processing, on and off; off, a scene shows its own curve at the look's exposure"},
    Key{GLFW_KEY_F11, 0, KeyAction::Fullscreen, "F11", "the whole screen, and back"},
    Key{GLFW_KEY_F12, 0, KeyAction::Screenshot, "F12", "stores the picture as a PNG"},
    Key{GLFW_KEY_F12, GLFW_MOD_SHIFT, KeyAction::WindowScreenshot, "Shift+F12", "stores the window as a PNG"},
    Key{GLFW_KEY_C, GLFW_MOD_CONTROL, KeyAction::Capture, "Ctrl+C",
        "stores the raw frame, which `develop` turns into the same picture"},
    Key{GLFW_KEY_GRAVE_ACCENT, 0, KeyAction::Console, "~", "the console"},
    Key{GLFW_KEY_TAB, 0, KeyAction::Panels, "Tab", "panels", false, true},
    Key{GLFW_KEY_S, GLFW_MOD_CONTROL, KeyAction::Save, "Ctrl+S", "saves into the file that was opened", false, true},
    Key{GLFW_KEY_Z, GLFW_MOD_CONTROL, KeyAction::Undo, "Ctrl+Z", "takes the last edit back", false, true},
    Key{GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, KeyAction::Redo, "Ctrl+Shift+Z", "makes it again", false, true},
    Key{GLFW_KEY_Y, GLFW_MOD_CONTROL, KeyAction::Redo, "Ctrl+Y", "the same", false, true},
    Key{GLFW_KEY_P, 0, KeyAction::Pause, "P", "stops the time, and continues it"},
    Key{GLFW_KEY_COMMA, 0, KeyAction::StepBack, ",", "one frame back in a sequence"},
    Key{GLFW_KEY_PERIOD, 0, KeyAction::StepForth, ".", "one frame on in a sequence"},
    Key{GLFW_KEY_SPACE, 0, KeyAction::ResetCamera, "Space", "the scene's own camera", false, true},
    Key{GLFW_KEY_F, 0, KeyAction::FrameAll, "F", "frames all", false, true},
    Key{GLFW_KEY_V, 0, KeyAction::CameraKind, "V", "the camera orbits, or flies", false, true},
    Key{GLFW_KEY_B, 0, KeyAction::Compare, "B", "compares two looks at a divider", false, true},
    // A character, wherever a keyboard has it: the interface reports it.
    Key{GLFW_KEY_UNKNOWN, relevant, KeyAction::KeySheet, "?", "this list of keys"},
    Key{GLFW_KEY_ESCAPE, 0, KeyAction::Leave, "Esc",
        "frees the mouse, then quits; press it twice if changes would be lost"},
};

}  // namespace

std::span<const Key> keys() { return table; }

std::uint32_t function_key(int key) {
    return key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12 ? static_cast<std::uint32_t>(key - GLFW_KEY_F1) + 1 : 0;
}

std::optional<KeyAction> action_of(const darkroom::window::KeyPress& press, bool is_edit) {
    for (const Key& key : table)
        if (key.key == press.key && key.modifiers == (press.modifiers & relevant) &&
            (is_edit ? key.is_for_edit : key.is_for_play))
            return key.action;
    if (function_key(press.key) != 0 && (press.modifiers & relevant) == 0) return KeyAction::Effect;
    return std::nullopt;
}

std::vector<KeyLine> key_lines() {
    std::vector<KeyLine> out{
        {"W A S D", "walks; with Shift it runs", true, false},
        {"W A S D Q E", "flies; with Shift faster", false, true},
        {"Space", "jumps", true, false},
        {"mouse", "looks around; a click captures the mouse, Esc frees it", true, false},
        {"mouse", "left orbits, middle pans, right looks around, the wheel goes nearer; on a stored frame it zooms",
         false, true},
    };
    // Those of effects stand among the others by their number.
    for (std::uint32_t number = 1; number <= 12; ++number) {
        for (const Key& key : table)
            if (function_key(key.key) == number) out.push_back({std::string(key.shown), key.doc});
        for (const darkroom::EffectInfo* const effect : darkroom::all_effects())
            if (effect->flat.toggle_key == number) out.push_back({fmt::format("F{}", number), effect->name});
    }
    for (const Key& key : table)
        if (function_key(key.key) == 0)
            out.push_back({std::string(key.shown), key.doc, key.is_for_play, key.is_for_edit});
    return out;
}

std::string keys_text() {
    std::string out;
    for (const KeyLine& line : key_lines())
        out += fmt::format("{:<14}{}{}\n", line.shown, line.doc,
                           line.is_for_play ? (line.is_for_edit ? "" : "  [play]") : "  [edit]");
    return out;
}

}  // namespace app
