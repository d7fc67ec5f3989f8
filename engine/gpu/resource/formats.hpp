// SPDX-License-Identifier: MIT
#pragma once
// What formats are, in one list: name, GLSL name, size, aspects, and how a shader sees the values. What a device can do
// with them is asked of the Context. A format that is not in the list passes for one of colour that can be sampled, and
// written as an attachment, but never loaded or stored; compressed and multi-planar formats are not in it.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string_view>

namespace darkroom::gpu {

enum class Numeric : std::uint8_t { Float, Signed, Unsigned };

struct FormatTraits {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::string_view glsl_qualifier;  ///< of storage images; empty: GLSL has none
    std::uint32_t bits = 0;           ///< a texel
    Numeric numeric = Numeric::Float;
    VkImageAspectFlags aspects = VK_IMAGE_ASPECT_COLOR_BIT;  ///< all that an image of the format has
    bool is_float = false;                                   ///< stored as floating-point numbers
    bool is_srgb = false;                                    ///< decoded when it is read, encoded when it is written
    bool needs_extended = false;                             ///< shaderStorageImageExtendedFormats
};

/// With bits = 0 for a format that the list does not hold.
[[nodiscard]] FormatTraits format_traits(VkFormat format);
/// "R16G16B16A16_SFLOAT"; "an unknown format" for one that the list does not hold.
[[nodiscard]] std::string_view format_name(VkFormat format);
/// By that name, in capitals or not. UNDEFINED: there is none.
[[nodiscard]] VkFormat format_named(std::string_view name);
[[nodiscard]] bool is_depth(VkFormat format);
[[nodiscard]] bool has_stencil(VkFormat format);
/// The one aspect that a view for sampling, or a copy, names: depth of depth formats with or without stencil.
[[nodiscard]] VkImageAspectFlags sampled_aspect(VkFormat format);

}  // namespace darkroom::gpu
