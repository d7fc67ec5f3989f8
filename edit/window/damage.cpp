// SPDX-License-Identifier: MIT
#include "window/damage.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "window/texture_address.hpp"

namespace darkroom::window {

namespace {

/// In Dear ImGui's coordinates.
struct Box {
    float left = std::numeric_limits<float>::max(), top = left, right = -left, bottom = -left;

    void add(ImVec2 point) {
        left = std::min(left, point.x);
        top = std::min(top, point.y);
        right = std::max(right, point.x);
        bottom = std::max(bottom, point.y);
    }
    [[nodiscard]] Box within(const ImVec4& clip) const {
        Box out;
        out.left = std::max(left, clip.x);
        out.top = std::max(top, clip.y);
        out.right = std::min(right, clip.z);
        out.bottom = std::min(bottom, clip.w);
        return out;
    }
};

VkRect2D pixels_of(const Box& box, const ImDrawData& data) {
    const auto pixel = [](float place, float origin, float scale, float size) {
        return static_cast<std::int32_t>(std::clamp((place - origin) * scale, 0.0F, size * scale));
    };
    if (box.left >= box.right || box.top >= box.bottom) return {};
    const ImVec2 origin = data.DisplayPos, scale = data.FramebufferScale, size = data.DisplaySize;
    // What is smoothed at its edge reaches into the pixel beside it.
    const VkOffset2D first{pixel(box.left - 1, origin.x, scale.x, size.x),
                           pixel(box.top - 1, origin.y, scale.y, size.y)};
    const VkOffset2D end{pixel(std::ceil(box.right) + 1, origin.x, scale.x, size.x),
                         pixel(std::ceil(box.bottom) + 1, origin.y, scale.y, size.y)};
    return {first, {static_cast<std::uint32_t>(end.x - first.x), static_cast<std::uint32_t>(end.y - first.y)}};
}

std::uint64_t area(const VkRect2D& of) { return std::uint64_t{of.extent.width} * of.extent.height; }

VkRect2D both(const VkRect2D& a, const VkRect2D& b) {
    const VkOffset2D first{std::min(a.offset.x, b.offset.x), std::min(a.offset.y, b.offset.y)};
    const auto end = [](std::int32_t one, std::uint32_t long_, std::int32_t other, std::uint32_t wide) {
        return std::max(one + static_cast<std::int32_t>(long_), other + static_cast<std::int32_t>(wide));
    };
    const std::int32_t right = end(a.offset.x, a.extent.width, b.offset.x, b.extent.width);
    const std::int32_t bottom = end(a.offset.y, a.extent.height, b.offset.y, b.extent.height);
    return {first, {static_cast<std::uint32_t>(right - first.x), static_cast<std::uint32_t>(bottom - first.y)}};
}

}  // namespace

void add_part(std::vector<VkRect2D>& parts, const VkRect2D& part) {
    if (area(part) == 0) return;
    VkRect2D added = part;
    const auto take = [&](std::size_t i) {
        added = both(added, parts[i]);
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
    };
    // Those that are drawn as quickly together.
    for (std::size_t i = 0; i < parts.size();)
        if (area(both(added, parts[i])) <= area(added) + area(parts[i])) {
            take(i);
            i = 0;
        } else {
            ++i;
        }
    if (parts.size() < max_damaged_parts) return parts.push_back(added);
    const auto growth = [&](const VkRect2D& with) { return area(both(added, with)) - area(with); };
    take(static_cast<std::size_t>(std::ranges::min_element(parts, {}, growth) - parts.begin()));
    add_part(parts, added);
}

struct Damage::List {
    const ImDrawList* of = nullptr;  ///< stays where it is as long as its window
    std::vector<ImDrawCmd> commands;
    std::vector<ImDrawVert> vertices;
    std::vector<ImDrawIdx> indices;

    explicit List(const ImDrawList& list)
        : of(&list),
          commands(list.CmdBuffer.begin(), list.CmdBuffer.end()),
          vertices(list.VtxBuffer.begin(), list.VtxBuffer.end()),
          indices(list.IdxBuffer.begin(), list.IdxBuffer.end()) {}

    [[nodiscard]] const ImDrawVert& corner(const ImDrawCmd& command, std::size_t i) const {
        return vertices[command.VtxOffset + indices[command.IdxOffset + i]];
    }
    /// Of the corners [first, end) of a command.
    [[nodiscard]] Box box(const ImDrawCmd& command, std::size_t first, std::size_t end) const {
        Box out;
        for (std::size_t i = first; i < end; ++i) out.add(corner(command, i).pos);
        return out.within(command.ClipRect);
    }
    template <class Add>
    void add_all(const Add& add) const {
        for (const ImDrawCmd& command : commands) add(box(command, 0, command.ElemCount));
    }
    /// What another command draws in the place of one: those triangles that neither all before nor all behind have.
    template <class Add>
    void add_changes(const ImDrawCmd& command, const List& other, const ImDrawCmd& by, const Add& add) const {
        const std::size_t count = command.ElemCount, other_count = by.ElemCount, least = std::min(count, other_count);
        const auto is_same = [&](std::size_t i, std::size_t other_i) {
            return std::memcmp(&corner(command, i), &other.corner(by, other_i), sizeof(ImDrawVert)) == 0;
        };
        constexpr std::size_t corners = 3;
        std::size_t first = 0, last = 0;
        while (first < least && is_same(first, first)) ++first;
        if (first == count && first == other_count) return;
        first -= first % corners;
        while (last < least - first && is_same(count - 1 - last, other_count - 1 - last)) ++last;
        last -= last % corners;
        add(box(command, first, count - last));
        add(other.box(by, first, other_count - last));
    }
};

Damage::Damage() = default;
Damage::Damage(Damage&&) noexcept = default;
Damage& Damage::operator=(Damage&&) noexcept = default;
Damage::~Damage() = default;

std::vector<VkRect2D> Damage::take(const ImDrawData& data, const void* fonts) {
    std::vector<List> now;
    for (int i = 0; i < data.CmdListsCount; ++i) now.emplace_back(*data.CmdLists[i]);
    const std::vector<List> before = std::exchange(before_, {});
    const std::array<float, 6> display{data.DisplayPos.x,  data.DisplayPos.y,       data.DisplaySize.x,
                                       data.DisplaySize.y, data.FramebufferScale.x, data.FramebufferScale.y};
    const bool is_resized = std::exchange(display_, display) != display;
    std::vector<VkRect2D> out;
    const auto add = [&](const Box& box) { add_part(out, pixels_of(box, data)); };
    const auto find = [](const std::vector<List>& in, const List& list) {
        return std::ranges::find(in, list.of, &List::of);
    };
    // What lies over what.
    std::vector<const ImDrawList*> order_before, order_now;
    for (const List& list : before)
        if (find(now, list) != now.end()) order_before.push_back(list.of);
    for (const List& list : now)
        if (find(before, list) != before.end()) order_now.push_back(list.of);
    if (is_resized || order_before != order_now) {
        before_ = std::move(now);
        add({.left = data.DisplayPos.x,
             .top = data.DisplayPos.y,
             .right = data.DisplayPos.x + data.DisplaySize.x,
             .bottom = data.DisplayPos.y + data.DisplaySize.y});
        return out;
    }
    for (const List& list : before)
        if (find(now, list) == now.end()) list.add_all(add);
    for (const List& list : now) {
        const auto was = find(before, list);
        if (was == before.end() || was->commands.size() != list.commands.size()) {
            list.add_all(add);
            if (was != before.end()) was->add_all(add);
            continue;
        }
        for (std::size_t i = 0; i < list.commands.size(); ++i) {
            const ImDrawCmd &command = list.commands[i], &other = was->commands[i];
            const void* const texture = address_of(command);
            const bool is_pane = texture != nullptr && texture != fonts;
            const bool is_alike = std::memcmp(&command.ClipRect, &other.ClipRect, sizeof(ImVec4)) == 0 &&
                                  texture == address_of(other) && command.UserCallback == other.UserCallback;
            if (is_alike && !is_pane && command.UserCallback == nullptr) {
                list.add_changes(command, *was, other, add);
                continue;
            }
            add(list.box(command, 0, command.ElemCount));
            add(was->box(other, 0, other.ElemCount));
        }
    }
    before_ = std::move(now);
    return out;
}

}  // namespace darkroom::window
