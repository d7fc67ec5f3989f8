// SPDX-License-Identifier: MIT
#pragma once
// Draws the lists of Dear ImGui on the CPU, for tests: triangles with the font atlas as their only texture, blended as
// ImGui means it, without a device.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace darkroom::panels {

/// RGBA, row-major, top row first, as encoded as ImGui's colours.
struct GuiPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return &rgba[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4];
    }
};

class GuiRasteriser {
  public:
    /// Builds the atlas of the present context, where it is not built yet.
    explicit GuiRasteriser(const ImVec4& background) : background_(background) {
        ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&atlas_, &atlas_width_, &atlas_height_);
    }

    [[nodiscard]] GuiPicture draw(const ImDrawData& data) {
        picture_ = {static_cast<int>(data.DisplaySize.x), static_cast<int>(data.DisplaySize.y), {}};
        picture_.rgba.resize(static_cast<std::size_t>(picture_.width) * static_cast<std::size_t>(picture_.height) * 4);
        for (std::size_t i = 0; i < picture_.rgba.size(); ++i)
            picture_.rgba[i] = static_cast<std::uint8_t>(std::lround((&background_.x)[i % 4] * 255));
        for (int i = 0; i < data.CmdListsCount; ++i) {
            const ImDrawList& list = *data.CmdLists[i];
            for (const ImDrawCmd& command : list.CmdBuffer) {
                if (command.UserCallback != nullptr) continue;
                for (unsigned k = 0; k < command.ElemCount; k += 3) {
                    const ImDrawIdx* const index = &list.IdxBuffer[static_cast<int>(command.IdxOffset + k)];
                    const auto vertex = [&](int corner) -> const ImDrawVert& {
                        return list.VtxBuffer[static_cast<int>(command.VtxOffset + index[corner])];
                    };
                    triangle(vertex(0), vertex(1), vertex(2), command.ClipRect);
                }
            }
        }
        return std::move(picture_);
    }

  private:
    static float channel(ImU32 color, int number) { return static_cast<float>(color >> (8 * number) & 255) / 255.0f; }

    // Sampled bilinearly, as backends do.
    [[nodiscard]] float atlas(float u, float v) const {
        const float x = u * static_cast<float>(atlas_width_) - 0.5f, y = v * static_cast<float>(atlas_height_) - 0.5f;
        const float left = std::floor(x), top = std::floor(y);
        const auto texel = [&](float column, float row) {
            const int i = std::clamp(static_cast<int>(column), 0, atlas_width_ - 1);
            const int j = std::clamp(static_cast<int>(row), 0, atlas_height_ - 1);
            return static_cast<float>(atlas_[j * atlas_width_ + i]) / 255.0f;
        };
        return std::lerp(std::lerp(texel(left, top), texel(left + 1, top), x - left),
                         std::lerp(texel(left, top + 1), texel(left + 1, top + 1), x - left), y - top);
    }

    void triangle(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, const ImVec4& clip) {
        const auto cross = [](const ImVec2& o, const ImVec2& p, float x, float y) {
            return (p.x - o.x) * (y - o.y) - (p.y - o.y) * (x - o.x);
        };
        const float area = cross(a.pos, b.pos, c.pos.x, c.pos.y);
        if (area == 0) return;
        const int left = first(std::min({a.pos.x, b.pos.x, c.pos.x}), clip.x);
        const int top = first(std::min({a.pos.y, b.pos.y, c.pos.y}), clip.y);
        const int right = last(std::max({a.pos.x, b.pos.x, c.pos.x}), clip.z, picture_.width);
        const int bottom = last(std::max({a.pos.y, b.pos.y, c.pos.y}), clip.w, picture_.height);
        // Of two triangles that share an edge, one has its pixels: that whose edge runs this way.
        const auto is_owned = [&](const ImVec2& from, const ImVec2& to) {
            const float dx = (to.x - from.x) * area, dy = (to.y - from.y) * area;
            return dy < 0 || (dy == 0 && dx > 0);
        };
        const bool owned[3] = {is_owned(b.pos, c.pos), is_owned(c.pos, a.pos), is_owned(a.pos, b.pos)};
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
                const float weights[3] = {cross(b.pos, c.pos, px, py) / area, cross(c.pos, a.pos, px, py) / area,
                                          cross(a.pos, b.pos, px, py) / area};
                bool is_inside = true;
                for (int i = 0; i < 3; ++i) is_inside &= weights[i] > 0 || (weights[i] == 0 && owned[i]);
                if (!is_inside) continue;
                const auto mixed = [&](float of_a, float of_b, float of_c) {
                    return of_a * weights[0] + of_b * weights[1] + of_c * weights[2];
                };
                const float coverage = atlas(mixed(a.uv.x, b.uv.x, c.uv.x), mixed(a.uv.y, b.uv.y, c.uv.y));
                const auto color = [&](int i) {
                    return mixed(channel(a.col, i), channel(b.col, i), channel(c.col, i));
                };
                const float alpha = color(3) * coverage;
                std::uint8_t* const out = const_cast<std::uint8_t*>(picture_.at(x, y));
                for (int i = 0; i < 3; ++i)
                    out[i] = static_cast<std::uint8_t>(
                        std::lround(std::lerp(static_cast<float>(out[i]), color(i) * 255.0f, alpha)));
            }
    }
    static int first(float corner, float clip) {
        return std::max(0, static_cast<int>(std::floor(std::max(corner, clip))));
    }
    static int last(float corner, float clip, int size) {
        return std::min(size, static_cast<int>(std::ceil(std::min(corner, clip))));
    }

    ImVec4 background_;
    unsigned char* atlas_ = nullptr;
    int atlas_width_ = 0, atlas_height_ = 0;
    GuiPicture picture_;
};

}  // namespace darkroom::panels
