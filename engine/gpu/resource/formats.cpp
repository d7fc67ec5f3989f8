// SPDX-License-Identifier: MIT
#include "gpu/resource/formats.hpp"

#include <algorithm>
#include <array>

#include "core/text/lower.hpp"

namespace darkroom::gpu {

namespace {

struct Row {
    std::string_view name;
    FormatTraits traits;
};

constexpr bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

constexpr VkImageAspectFlags aspects_of_name(std::string_view name) {
    const bool is_stencil = has(name, "S8_UINT");
    if (!has(name, "D16") && !has(name, "D24") && !has(name, "D32")) {
        return is_stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    }
    return VK_IMAGE_ASPECT_DEPTH_BIT | (is_stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0);
}

constexpr Numeric numeric_of_name(std::string_view name) {
    // The stencil part of a depth format is never read by a shader here.
    if (has(name, "_UINT") && !has(name, "_S8_UINT")) return Numeric::Unsigned;
    return has(name, "_SINT") ? Numeric::Signed : Numeric::Float;
}

/// What a format's name says need not be said again. `extended`: it needs shaderStorageImageExtendedFormats.
constexpr Row row(VkFormat format, std::string_view name, std::uint32_t bits, std::string_view glsl_qualifier = {},
                  bool extended = false) {
    return {name,
            {.format = format,
             .glsl_qualifier = glsl_qualifier,
             .bits = bits,
             .numeric = numeric_of_name(name),
             .aspects = aspects_of_name(name),
             .is_float = has(name, "FLOAT"),
             .is_srgb = has(name, "_SRGB"),
             .needs_extended = extended}};
}

// Vulkan 1.3 specification, "Compatibility Between SPIR-V Image Formats And Vulkan Formats", and the list of formats
// that need shaderStorageImageExtendedFormats.
constexpr std::array rows{
    row(VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", 32, "rgba8"),
    row(VK_FORMAT_R8G8B8A8_SNORM, "R8G8B8A8_SNORM", 32, "rgba8_snorm"),
    row(VK_FORMAT_R8G8B8A8_UINT, "R8G8B8A8_UINT", 32, "rgba8ui"),
    row(VK_FORMAT_R8G8B8A8_SINT, "R8G8B8A8_SINT", 32, "rgba8i"),
    row(VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB", 32),
    row(VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM", 32),
    row(VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB", 32),
    row(VK_FORMAT_B8G8R8A8_SNORM, "B8G8R8A8_SNORM", 32),
    row(VK_FORMAT_A8B8G8R8_UNORM_PACK32, "A8B8G8R8_UNORM_PACK32", 32),
    row(VK_FORMAT_A8B8G8R8_SNORM_PACK32, "A8B8G8R8_SNORM_PACK32", 32),
    row(VK_FORMAT_A8B8G8R8_SRGB_PACK32, "A8B8G8R8_SRGB_PACK32", 32),
    row(VK_FORMAT_A2R10G10B10_UNORM_PACK32, "A2R10G10B10_UNORM_PACK32", 32),
    row(VK_FORMAT_A2B10G10R10_UNORM_PACK32, "A2B10G10R10_UNORM_PACK32", 32, "rgb10_a2", true),
    row(VK_FORMAT_A2B10G10R10_UINT_PACK32, "A2B10G10R10_UINT_PACK32", 32, "rgb10_a2ui", true),
    row(VK_FORMAT_B10G11R11_UFLOAT_PACK32, "B10G11R11_UFLOAT_PACK32", 32, "r11f_g11f_b10f", true),
    row(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, "E5B9G9R9_UFLOAT_PACK32", 32),
    row(VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT", 64, "rgba16f"),
    row(VK_FORMAT_R16G16B16A16_UNORM, "R16G16B16A16_UNORM", 64, "rgba16", true),
    row(VK_FORMAT_R16G16B16A16_SNORM, "R16G16B16A16_SNORM", 64, "rgba16_snorm", true),
    row(VK_FORMAT_R16G16B16A16_UINT, "R16G16B16A16_UINT", 64, "rgba16ui"),
    row(VK_FORMAT_R16G16B16A16_SINT, "R16G16B16A16_SINT", 64, "rgba16i"),
    row(VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT", 128, "rgba32f"),
    row(VK_FORMAT_R32G32B32A32_UINT, "R32G32B32A32_UINT", 128, "rgba32ui"),
    row(VK_FORMAT_R32G32B32A32_SINT, "R32G32B32A32_SINT", 128, "rgba32i"),
    row(VK_FORMAT_R32G32B32_SFLOAT, "R32G32B32_SFLOAT", 96),
    row(VK_FORMAT_R32G32_SFLOAT, "R32G32_SFLOAT", 64, "rg32f", true),
    row(VK_FORMAT_R32G32_UINT, "R32G32_UINT", 64, "rg32ui", true),
    row(VK_FORMAT_R32G32_SINT, "R32G32_SINT", 64, "rg32i", true),
    row(VK_FORMAT_R32_SFLOAT, "R32_SFLOAT", 32, "r32f"),
    row(VK_FORMAT_R32_UINT, "R32_UINT", 32, "r32ui"),
    row(VK_FORMAT_R32_SINT, "R32_SINT", 32, "r32i"),
    row(VK_FORMAT_R16G16_SFLOAT, "R16G16_SFLOAT", 32, "rg16f", true),
    row(VK_FORMAT_R16G16_UNORM, "R16G16_UNORM", 32, "rg16", true),
    row(VK_FORMAT_R16G16_SNORM, "R16G16_SNORM", 32, "rg16_snorm", true),
    row(VK_FORMAT_R16G16_UINT, "R16G16_UINT", 32, "rg16ui", true),
    row(VK_FORMAT_R16G16_SINT, "R16G16_SINT", 32, "rg16i", true),
    row(VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", 16, "r16f", true),
    row(VK_FORMAT_R16_UNORM, "R16_UNORM", 16, "r16", true),
    row(VK_FORMAT_R16_SNORM, "R16_SNORM", 16, "r16_snorm", true),
    row(VK_FORMAT_R16_UINT, "R16_UINT", 16, "r16ui", true),
    row(VK_FORMAT_R16_SINT, "R16_SINT", 16, "r16i", true),
    row(VK_FORMAT_R8G8_UNORM, "R8G8_UNORM", 16, "rg8", true),
    row(VK_FORMAT_R8G8_SNORM, "R8G8_SNORM", 16, "rg8_snorm", true),
    row(VK_FORMAT_R8G8_UINT, "R8G8_UINT", 16, "rg8ui", true),
    row(VK_FORMAT_R8G8_SINT, "R8G8_SINT", 16, "rg8i", true),
    row(VK_FORMAT_R8_UNORM, "R8_UNORM", 8, "r8", true),
    row(VK_FORMAT_R8_SNORM, "R8_SNORM", 8, "r8_snorm", true),
    row(VK_FORMAT_R8_UINT, "R8_UINT", 8, "r8ui", true),
    row(VK_FORMAT_R8_SINT, "R8_SINT", 8, "r8i", true),
    row(VK_FORMAT_R8_SRGB, "R8_SRGB", 8),
    row(VK_FORMAT_R8G8_SRGB, "R8G8_SRGB", 16),
    row(VK_FORMAT_R5G6B5_UNORM_PACK16, "R5G6B5_UNORM_PACK16", 16),
    row(VK_FORMAT_B5G6R5_UNORM_PACK16, "B5G6R5_UNORM_PACK16", 16),
    row(VK_FORMAT_A1R5G5B5_UNORM_PACK16, "A1R5G5B5_UNORM_PACK16", 16),
    row(VK_FORMAT_R5G5B5A1_UNORM_PACK16, "R5G5B5A1_UNORM_PACK16", 16),
    row(VK_FORMAT_R4G4B4A4_UNORM_PACK16, "R4G4B4A4_UNORM_PACK16", 16),
    row(VK_FORMAT_B4G4R4A4_UNORM_PACK16, "B4G4R4A4_UNORM_PACK16", 16),
    row(VK_FORMAT_D16_UNORM, "D16_UNORM", 16),
    row(VK_FORMAT_X8_D24_UNORM_PACK32, "X8_D24_UNORM_PACK32", 32),
    row(VK_FORMAT_D32_SFLOAT, "D32_SFLOAT", 32),
    row(VK_FORMAT_S8_UINT, "S8_UINT", 8),
    row(VK_FORMAT_D16_UNORM_S8_UINT, "D16_UNORM_S8_UINT", 24),
    row(VK_FORMAT_D24_UNORM_S8_UINT, "D24_UNORM_S8_UINT", 32),
    row(VK_FORMAT_D32_SFLOAT_S8_UINT, "D32_SFLOAT_S8_UINT", 40),
    // No shader of ours sees them, and none may take them for colours.
    row(VK_FORMAT_R8G8B8_UINT, "R8G8B8_UINT", 24),
    row(VK_FORMAT_R8G8B8_SINT, "R8G8B8_SINT", 24),
    row(VK_FORMAT_B8G8R8_UINT, "B8G8R8_UINT", 24),
    row(VK_FORMAT_B8G8R8_SINT, "B8G8R8_SINT", 24),
    row(VK_FORMAT_B8G8R8A8_UINT, "B8G8R8A8_UINT", 32),
    row(VK_FORMAT_B8G8R8A8_SINT, "B8G8R8A8_SINT", 32),
    row(VK_FORMAT_A8B8G8R8_UINT_PACK32, "A8B8G8R8_UINT_PACK32", 32),
    row(VK_FORMAT_A8B8G8R8_SINT_PACK32, "A8B8G8R8_SINT_PACK32", 32),
    row(VK_FORMAT_A2R10G10B10_UINT_PACK32, "A2R10G10B10_UINT_PACK32", 32),
    row(VK_FORMAT_A2R10G10B10_SINT_PACK32, "A2R10G10B10_SINT_PACK32", 32),
    row(VK_FORMAT_A2B10G10R10_SINT_PACK32, "A2B10G10R10_SINT_PACK32", 32),
    row(VK_FORMAT_R16G16B16_UINT, "R16G16B16_UINT", 48),
    row(VK_FORMAT_R16G16B16_SINT, "R16G16B16_SINT", 48),
    row(VK_FORMAT_R32G32B32_UINT, "R32G32B32_UINT", 96),
    row(VK_FORMAT_R32G32B32_SINT, "R32G32B32_SINT", 96),
    row(VK_FORMAT_R64_UINT, "R64_UINT", 64),
    row(VK_FORMAT_R64_SINT, "R64_SINT", 64),
    row(VK_FORMAT_R64G64_UINT, "R64G64_UINT", 128),
    row(VK_FORMAT_R64G64_SINT, "R64G64_SINT", 128),
    row(VK_FORMAT_R64G64B64_UINT, "R64G64B64_UINT", 192),
    row(VK_FORMAT_R64G64B64_SINT, "R64G64B64_SINT", 192),
    row(VK_FORMAT_R64G64B64A64_UINT, "R64G64B64A64_UINT", 256),
    row(VK_FORMAT_R64G64B64A64_SINT, "R64G64B64A64_SINT", 256),
};

const Row* find_row(VkFormat format) {
    const auto found = std::ranges::find(rows, format, [](const Row& candidate) { return candidate.traits.format; });
    return found == rows.end() ? nullptr : &*found;
}

}  // namespace

FormatTraits format_traits(VkFormat format) {
    const Row* const found = find_row(format);
    return found == nullptr ? FormatTraits{.format = format} : found->traits;
}

std::string_view format_name(VkFormat format) {
    const Row* const found = find_row(format);
    return found == nullptr ? std::string_view("an unknown format") : found->name;
}

VkFormat format_named(std::string_view name) {
    const auto found =
        std::ranges::find_if(rows, [&](const Row& candidate) { return lower(candidate.name) == lower(name); });
    return found == rows.end() ? VK_FORMAT_UNDEFINED : found->traits.format;
}

bool is_depth(VkFormat format) { return (format_traits(format).aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0; }

bool has_stencil(VkFormat format) { return (format_traits(format).aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0; }

VkImageAspectFlags sampled_aspect(VkFormat format) {
    if (is_depth(format)) return VK_IMAGE_ASPECT_DEPTH_BIT;
    return format_traits(format).aspects;
}

}  // namespace darkroom::gpu
