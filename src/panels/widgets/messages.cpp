// SPDX-License-Identifier: MIT
#include "panels/widgets/messages.hpp"

#include <imgui.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

constexpr std::size_t most_messages = 16;

float text_width(float width) { return width - ImGui::GetFrameHeight() - 3 * ImGui::GetStyle().ItemSpacing.x; }
float text_height(const std::string& text, float width) {
    const float height = ImGui::CalcTextSize(text.c_str(), nullptr, false, text_width(width)).y;
    return std::max(height + 2 * ImGui::GetStyle().FramePadding.y, ImGui::GetFrameHeight());
}

}  // namespace

void Messages::report(std::string_view source, const Error& error) {
    clear(source);
    if (shown_.size() == most_messages) shown_.erase(shown_.begin());
    shown_.push_back({std::string(source), printable(error.text)});
}

void Messages::clear(std::string_view source) {
    std::erase_if(shown_, [&](const Message& message) { return message.source == source; });
}

bool Messages::settle(std::string_view source, const Result<>& result) {
    if (result)
        clear(source);
    else
        report(source, result.error());
    return result.has_value();
}

std::vector<std::string> Messages::texts() const {
    std::vector<std::string> out;
    for (const Message& message : shown_) out.push_back(message.text);
    return out;
}

float Messages::height(float width) const {
    float sum = 0;
    for (const Message& message : shown_) sum += text_height(message.text, width) + ImGui::GetStyle().ItemSpacing.y;
    return sum;
}

void Messages::draw() {
    const float width = ImGui::GetContentRegionAvail().x;
    const float pad = ImGui::GetStyle().FramePadding.y, gap = ImGui::GetStyle().ItemSpacing.x;
    std::string closed;
    for (const Message& message : shown_) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float height = text_height(message.text, width);
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const ImVec2 end{corner.x + width, corner.y + height};
        list.AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
        list.AddRectFilled(corner, {corner.x + gap / 2, end.y}, ImGui::GetColorU32(accent_color));
        ImGui::PushID(message.source.c_str());
        ImGui::SetCursorScreenPos({corner.x + 1.5f * gap, corner.y + pad});
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + text_width(width));
        ImGui::TextUnformatted(message.text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::SetCursorScreenPos({end.x - ImGui::GetFrameHeight(), corner.y});
        if (icon_button("##close", Icon::Remove, "Put this message away")) closed = message.source;
        ImGui::SetCursorScreenPos(corner);
        ImGui::Dummy({width, height});
        ImGui::PopID();
    }
    if (!closed.empty()) clear(closed);
}

}  // namespace darkroom::panels
