// SPDX-License-Identifier: MIT
#pragma once
// A picture shown in the interface: which image, and how its numbers become light on the screen. A pane is handed to
// Dear ImGui as a texture (ImGui::Image, ImDrawList::AddImage), and drawn by GuiPass.

#include <cstdint>
#include <darkroom/frame.hpp>
#include <optional>

namespace darkroom::window {

/// What the numbers of an image mean.
enum class PaneTransfer : std::uint32_t {
    Encoded,      ///< sRGB-encoded already: shown as it is
    SceneLinear,  ///< linear Rec. 709, 1 is white: sRGB-encoded to be shown
    Raw,          ///< data: [low, high] becomes black to white, without a transfer function
    /// Where a thing was less where it is, in pixels, y down: a wheel of hues, full at `high` pixels, and arrows.
    Motion,
};

/// A grey picture of one of them, or all three.
enum class PaneChannels : std::uint32_t { Rgb, Red, Green, Blue, Alpha, Luminance };

struct PaneView {
    /// As it is when the interface is drawn: in a layout that a fragment shader may sample in, of a format that is read
    /// as floats. Only view, format, extent, region and layout are read; of one that is not given nothing is drawn.
    ImageRef image;
    PaneTransfer transfer = PaneTransfer::Encoded;
    float low = 0, high = 1;  ///< PaneTransfer::Raw, Motion
};

/// Texture coordinates (0, 0) to (1, 1) are the image's region.
struct Pane {
    PaneView view;
    std::optional<PaneView> second;  ///< shown right of the divider, at the same texture coordinates
    float divider = 0.5f;            ///< in texture coordinates, from the left
    float exposure = 0;              ///< stops; of light, so Raw and alpha do not have it
    PaneChannels channels = PaneChannels::Rgb;
    bool is_false_color = false;      ///< panels/show/false_color.hpp; not of Raw and alpha
    bool is_clipping_marked = false;  ///< stripes under 0 (blue) and from 1 up (red), NaN and infinities in magenta
    bool is_nearest = false;          ///< texels as squares

    /// For ImGui::Image. The pane stays where it is until the interface is recorded.
    [[nodiscard]] void* texture() const { return const_cast<Pane*>(this); }
};

}  // namespace darkroom::window
