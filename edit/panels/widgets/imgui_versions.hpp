// SPDX-License-Identifier: MIT
#pragma once
// What differs between the versions of Dear ImGui that panels are compiled against, 1.86 and from 1.89 on: keys, which
// had numbers of the backend and no queue before 1.87. No other file asks for the version.

#include <imgui.h>
#include <imgui_internal.h>

namespace darkroom::panels {

#if IMGUI_VERSION_NUM < 18700

inline constexpr bool has_key_queue = false;
inline constexpr ImGuiKey keypad_enter = ImGuiKey_KeyPadEnter;

/// Went down in this frame, or is held and repeats.
inline bool is_pressed(ImGuiKey key, bool repeats = true) {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeats);
}
/// A key by the backend's number. Is it one that ImGui knows?
inline bool set_backend_key(int key, bool is_down) {
    ImGuiIO& io = ImGui::GetIO();
    if (key < 0 || key >= IM_ARRAYSIZE(io.KeysDown)) return false;
    io.KeysDown[key] = is_down;
    return true;
}
/// Where no backend sends them: ImGui's own numbers are the backend's.
inline void use_own_keys() {
    for (int key = 0; key < ImGuiKey_COUNT; ++key) ImGui::GetIO().KeyMap[key] = key;
}
inline void send_key(ImGuiKey key, bool is_down) { ImGui::GetIO().KeysDown[key] = is_down; }
inline void send_control(bool is_down) { ImGui::GetIO().KeyCtrl = is_down; }
inline void send_alt(bool is_down) { ImGui::GetIO().KeyAlt = is_down; }
inline bool has_input_waiting() { return false; }

#else

inline constexpr bool has_key_queue = true;
inline constexpr ImGuiKey keypad_enter = ImGuiKey_KeypadEnter;

inline bool is_pressed(ImGuiKey key, bool repeats = true) { return ImGui::IsKeyPressed(key, repeats); }
inline bool set_backend_key(int, bool) { return false; }
inline void use_own_keys() {}
inline void send_key(ImGuiKey key, bool is_down) { ImGui::GetIO().AddKeyEvent(key, is_down); }
inline void send_control(bool is_down) { send_key(ImGuiMod_Ctrl, is_down); }
inline void send_alt(bool is_down) { send_key(ImGuiMod_Alt, is_down); }
/// A frame takes as much of what was typed as cannot be mistaken; the rest is for the next ones.
inline bool has_input_waiting() { return GImGui != nullptr && !GImGui->InputEventsQueue.empty(); }

#endif

}  // namespace darkroom::panels
