// SPDX-License-Identifier: MIT
#pragma once
// Which of a surface's formats a window takes, and what its numbers mean then. Pure: from a list to a choice.

#include <vulkan/vulkan.h>

#include <darkroom/color_state.hpp>
#include <optional>
#include <span>

namespace darkroom::window {

enum class DynamicRange : std::uint32_t {
    Standard,
    High,  ///< where the surface has a format for it, else as Standard
};

struct SurfaceChoice {
    VkSurfaceFormatKHR format{};
    /// What the images hold. Of another range than sRGB's it goes up to `peak_nits`.
    ColorState color = srgb_color;
};

/// Of high range scRGB in half floats first, whose blending is that of light, then PQ and HLG in 10 bits. Of standard
/// range UNORM, so that encoded pictures are shown as they are. Nothing: there are no formats.
[[nodiscard]] std::optional<SurfaceChoice> choose_surface(std::span<const VkSurfaceFormatKHR> formats,
                                                          DynamicRange wanted, float peak_nits);

/// What a display is told of pictures in this state: SMPTE ST 2086 and CTA-861.3, with the primaries of the container.
[[nodiscard]] VkHdrMetadataEXT hdr_metadata(const ColorState& color);

}  // namespace darkroom::window
