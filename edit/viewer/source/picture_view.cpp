// SPDX-License-Identifier: MIT
#include "picture_view.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "panels/widgets/theme.hpp"

namespace app {

namespace {

constexpr float min_zoom = 1.0F / 16, max_zoom = 64;
/// How near to the divider a press takes it, in heights of the font.
constexpr float grip_height = 1.6F;

}  // namespace

void PictureView::draw(const Shown& shown, const VkRect2D& area) {
    const ImVec2 corner{static_cast<float>(area.offset.x), static_cast<float>(area.offset.y)};
    const ImVec2 room{static_cast<float>(area.extent.width), static_cast<float>(area.extent.height)};
    const ImVec2 end{corner.x + room.x, corner.y + room.y};
    const auto width = static_cast<float>(std::max(shown.extent.width, 1U));
    const auto height = static_cast<float>(std::max(shown.extent.height, 1U));
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    const bool is_free =
        !io.WantCaptureMouse && mouse.x >= corner.x && mouse.y >= corner.y && mouse.x < end.x && mouse.y < end.y;

    const float fitted = std::min(room.x / width, room.y / height);
    if (shown.can_zoom && is_free && io.MouseWheel != 0) {
        // What is under the mouse stays there.
        const float old = zoom_ > 0 ? zoom_ : fitted;
        const float now = std::clamp(old * std::pow(1.25F, io.MouseWheel), min_zoom, max_zoom);
        const ImVec2 from_middle{mouse.x - corner.x - room.x / 2, mouse.y - corner.y - room.y / 2};
        center_x_ += from_middle.x * (1 / old - 1 / now) / width;
        center_y_ += from_middle.y * (1 / old - 1 / now) / height;
        zoom_ = now;
    }
    if (zoom_ == 0) center_x_ = center_y_ = 0.5F;
    const float zoom = zoom_ > 0 ? zoom_ : fitted;
    const bool is_middle = !io.WantCaptureMouse && ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0);
    if (shown.can_zoom && (is_middle || (is_panning_ && !is_dragging_))) {
        center_x_ -= io.MouseDelta.x / (zoom * width);
        center_y_ -= io.MouseDelta.y / (zoom * height);
    }
    center_x_ = std::clamp(center_x_, 0.0F, 1.0F);
    center_y_ = std::clamp(center_y_, 0.0F, 1.0F);
    // On whole pixels, so that a picture as large as the area is shown as it is.
    const ImVec2 from{std::round(corner.x + room.x / 2 - center_x_ * width * zoom),
                      std::round(corner.y + room.y / 2 - center_y_ * height * zoom)};
    const ImVec2 to{from.x + width * zoom, from.y + height * zoom};

    const float grip = grip_height * ImGui::GetFontSize();
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) is_panning_ = false;
    if (!shown.second) {
        is_dragging_ = false;
    } else {
        const float at = from.x + pane_.divider * (to.x - from.x);
        if (is_free && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && std::abs(mouse.x - at) < grip)
            is_dragging_ = true;
        if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) is_dragging_ = false;
        if (is_dragging_) pane_.divider = std::clamp((mouse.x - from.x) / (to.x - from.x), 0.0F, 1.0F);
        if (is_dragging_ || (is_free && std::abs(mouse.x - at) < grip))
            ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    }
    // What is larger than its area is taken by the hand.
    if (shown.can_zoom && zoom_ > fitted && is_free && !is_dragging_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        is_panning_ = true;
    pane_.view = shown.first;
    pane_.second = shown.second;
    pane_.is_nearest = zoom >= 2;

    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    list->PushClipRect(corner, end);
    list->AddRectFilled(corner, end, ImGui::ColorConvertFloat4ToU32(darkroom::panels::surround_color));
    if (shown.first.image.is_given()) list->AddImage(pane_.texture(), from, to);
    if (shown.second) draw_names(shown, area, from.x + pane_.divider * (to.x - from.x));
    if (shown.marked) {
        const ImVec2 middle{from.x + (static_cast<float>(shown.marked->x) + 0.5F) * zoom,
                            from.y + (static_cast<float>(shown.marked->y) + 0.5F) * zoom};
        const float radius = std::max(ImGui::GetFontSize() / 2, zoom);
        // Two rings: one of them is seen on any picture.
        list->AddCircle(middle, radius + 1, IM_COL32(0, 0, 0, 255), 0, 3);
        list->AddCircle(middle, radius + 1, IM_COL32(255, 255, 255, 255), 0, 1);
    }
    list->PopClipRect();

    pointed_.reset();
    if (!is_free) return;
    const VkOffset2D pixel{static_cast<std::int32_t>(std::floor((mouse.x - from.x) / zoom)),
                           static_cast<std::int32_t>(std::floor((mouse.y - from.y) / zoom))};
    if (pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<std::int32_t>(shown.extent.width) &&
        pixel.y < static_cast<std::int32_t>(shown.extent.height))
        pointed_ = pixel;
}

// On either side of the divider, at the top of the picture.
void PictureView::draw_names(const Shown& shown, const VkRect2D& area, float divider) const {
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    const float pad = std::round(ImGui::GetFontSize() / 3), left = static_cast<float>(area.offset.x);
    const float right = left + static_cast<float>(area.extent.width);
    const float at = std::clamp(divider, left, right), top = static_cast<float>(area.offset.y) + 2 * pad;
    const auto name = [&](const std::string& text, float x) {
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        list->AddRectFilled({x, top}, {x + size.x + 2 * pad, top + size.y + 2 * pad}, IM_COL32(16, 16, 16, 200), pad);
        list->AddText({x + pad, top + pad}, IM_COL32(230, 230, 230, 255), text.c_str());
    };
    name(shown.first_name, at - ImGui::CalcTextSize(shown.first_name.c_str()).x - 4 * pad);
    name(shown.second_name, at + 2 * pad);
}

}  // namespace app
