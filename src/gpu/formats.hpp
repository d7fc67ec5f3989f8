// SPDX-License-Identifier: MIT
#pragma once
// What the kernels need to know of a colour format: its name in GLSL, its size, and how a shader sees its values.
// Formats that are not in the table can be sampled, and written as attachments, but never loaded or stored.

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
    bool needs_extended = false;  ///< shaderStorageImageExtendedFormats
};

/// With bits = 0 for a format that the table does not hold.
[[nodiscard]] FormatTraits format_traits(VkFormat format);
/// "R16G16B16A16_SFLOAT"; "an unknown format" for one that the table does not hold.
[[nodiscard]] std::string_view format_name(VkFormat format);

}  // namespace darkroom::gpu
