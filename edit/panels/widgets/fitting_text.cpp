// SPDX-License-Identifier: MIT
#include "panels/widgets/fitting_text.hpp"

#include <imgui.h>

namespace darkroom::panels {

std::string fitting(const std::string& text, float width, KeptPart kept) {
    const auto fits = [&](const std::string& part) { return ImGui::CalcTextSize(part.c_str()).x <= width; };
    if (fits(text)) return text;
    for (std::size_t gone = 1; gone < text.size(); ++gone) {
        const std::size_t cut = kept == KeptPart::End ? gone : text.size() - gone;
        // Not within a letter of UTF-8.
        if ((static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) continue;
        const std::string part = kept == KeptPart::End ? "..." + text.substr(cut) : text.substr(0, cut) + "...";
        if (fits(part)) return part;
    }
    return {};
}

}  // namespace darkroom::panels
