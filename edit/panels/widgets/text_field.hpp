// SPDX-License-Identifier: MIT
#pragma once
// ImGui's text field over a std::string, which its core leaves to its users.

#include <imgui.h>

#include <string>

namespace darkroom::panels {

inline bool text_field(const char* label, const char* hint, std::string& text, ImGuiInputTextFlags flags = 0) {
    const auto grow = [](ImGuiInputTextCallbackData* data) {
        if (data->EventFlag != ImGuiInputTextFlags_CallbackResize) return 0;
        auto& own = *static_cast<std::string*>(data->UserData);
        own.resize(static_cast<std::size_t>(data->BufTextLen));
        data->Buf = own.data();
        return 0;
    };
    return ImGui::InputTextWithHint(label, hint, text.data(), text.capacity() + 1,
                                    flags | ImGuiInputTextFlags_CallbackResize, grow, &text);
}

}  // namespace darkroom::panels
