// SPDX-License-Identifier: MIT
#include "gpu/formats.hpp"

#include <algorithm>
#include <array>

namespace darkroom::gpu {

namespace {

struct Row {
    std::string_view name;
    FormatTraits traits;
};

// Vulkan 1.3 specification, "Compatibility Between SPIR-V Image Formats And Vulkan Formats", and the list of formats
// that need shaderStorageImageExtendedFormats.
constexpr std::array rows{
    Row{"R8G8B8A8_UNORM", {VK_FORMAT_R8G8B8A8_UNORM, "rgba8", 32, Numeric::Float, false}},
    Row{"R8G8B8A8_SNORM", {VK_FORMAT_R8G8B8A8_SNORM, "rgba8_snorm", 32, Numeric::Float, false}},
    Row{"R8G8B8A8_UINT", {VK_FORMAT_R8G8B8A8_UINT, "rgba8ui", 32, Numeric::Unsigned, false}},
    Row{"R8G8B8A8_SINT", {VK_FORMAT_R8G8B8A8_SINT, "rgba8i", 32, Numeric::Signed, false}},
    Row{"R8G8B8A8_SRGB", {VK_FORMAT_R8G8B8A8_SRGB, "", 32, Numeric::Float, false}},
    Row{"B8G8R8A8_UNORM", {VK_FORMAT_B8G8R8A8_UNORM, "", 32, Numeric::Float, false}},
    Row{"B8G8R8A8_SRGB", {VK_FORMAT_B8G8R8A8_SRGB, "", 32, Numeric::Float, false}},
    Row{"A8B8G8R8_UNORM_PACK32", {VK_FORMAT_A8B8G8R8_UNORM_PACK32, "", 32, Numeric::Float, false}},
    Row{"A8B8G8R8_SRGB_PACK32", {VK_FORMAT_A8B8G8R8_SRGB_PACK32, "", 32, Numeric::Float, false}},
    Row{"A2R10G10B10_UNORM_PACK32", {VK_FORMAT_A2R10G10B10_UNORM_PACK32, "", 32, Numeric::Float, false}},
    Row{"A2B10G10R10_UNORM_PACK32", {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "rgb10_a2", 32, Numeric::Float, true}},
    Row{"B10G11R11_UFLOAT_PACK32", {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "r11f_g11f_b10f", 32, Numeric::Float, true}},
    Row{"R16G16B16A16_SFLOAT", {VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f", 64, Numeric::Float, false}},
    Row{"R16G16B16A16_UNORM", {VK_FORMAT_R16G16B16A16_UNORM, "rgba16", 64, Numeric::Float, true}},
    Row{"R16G16B16A16_SNORM", {VK_FORMAT_R16G16B16A16_SNORM, "rgba16_snorm", 64, Numeric::Float, true}},
    Row{"R16G16B16A16_UINT", {VK_FORMAT_R16G16B16A16_UINT, "rgba16ui", 64, Numeric::Unsigned, false}},
    Row{"R16G16B16A16_SINT", {VK_FORMAT_R16G16B16A16_SINT, "rgba16i", 64, Numeric::Signed, false}},
    Row{"R32G32B32A32_SFLOAT", {VK_FORMAT_R32G32B32A32_SFLOAT, "rgba32f", 128, Numeric::Float, false}},
    Row{"R32G32B32A32_UINT", {VK_FORMAT_R32G32B32A32_UINT, "rgba32ui", 128, Numeric::Unsigned, false}},
    Row{"R32G32B32A32_SINT", {VK_FORMAT_R32G32B32A32_SINT, "rgba32i", 128, Numeric::Signed, false}},
    Row{"R32G32_SFLOAT", {VK_FORMAT_R32G32_SFLOAT, "rg32f", 64, Numeric::Float, true}},
    Row{"R32G32_UINT", {VK_FORMAT_R32G32_UINT, "rg32ui", 64, Numeric::Unsigned, true}},
    Row{"R32G32_SINT", {VK_FORMAT_R32G32_SINT, "rg32i", 64, Numeric::Signed, true}},
    Row{"R32_SFLOAT", {VK_FORMAT_R32_SFLOAT, "r32f", 32, Numeric::Float, false}},
    Row{"R32_UINT", {VK_FORMAT_R32_UINT, "r32ui", 32, Numeric::Unsigned, false}},
    Row{"R32_SINT", {VK_FORMAT_R32_SINT, "r32i", 32, Numeric::Signed, false}},
    Row{"R16G16_SFLOAT", {VK_FORMAT_R16G16_SFLOAT, "rg16f", 32, Numeric::Float, true}},
    Row{"R16G16_UNORM", {VK_FORMAT_R16G16_UNORM, "rg16", 32, Numeric::Float, true}},
    Row{"R16G16_SNORM", {VK_FORMAT_R16G16_SNORM, "rg16_snorm", 32, Numeric::Float, true}},
    Row{"R16G16_UINT", {VK_FORMAT_R16G16_UINT, "rg16ui", 32, Numeric::Unsigned, true}},
    Row{"R16_SFLOAT", {VK_FORMAT_R16_SFLOAT, "r16f", 16, Numeric::Float, true}},
    Row{"R16_UNORM", {VK_FORMAT_R16_UNORM, "r16", 16, Numeric::Float, true}},
    Row{"R16_SNORM", {VK_FORMAT_R16_SNORM, "r16_snorm", 16, Numeric::Float, true}},
    Row{"R16_UINT", {VK_FORMAT_R16_UINT, "r16ui", 16, Numeric::Unsigned, true}},
    Row{"R8G8_UNORM", {VK_FORMAT_R8G8_UNORM, "rg8", 16, Numeric::Float, true}},
    Row{"R8G8_SNORM", {VK_FORMAT_R8G8_SNORM, "rg8_snorm", 16, Numeric::Float, true}},
    Row{"R8G8_UINT", {VK_FORMAT_R8G8_UINT, "rg8ui", 16, Numeric::Unsigned, true}},
    Row{"R8_UNORM", {VK_FORMAT_R8_UNORM, "r8", 8, Numeric::Float, true}},
    Row{"R8_SNORM", {VK_FORMAT_R8_SNORM, "r8_snorm", 8, Numeric::Float, true}},
    Row{"R8_UINT", {VK_FORMAT_R8_UINT, "r8ui", 8, Numeric::Unsigned, true}},
};

const Row* find_row(VkFormat format) {
    const auto row = std::ranges::find(rows, format, [](const Row& candidate) { return candidate.traits.format; });
    return row == rows.end() ? nullptr : &*row;
}

}  // namespace

FormatTraits format_traits(VkFormat format) {
    const Row* const row = find_row(format);
    return row == nullptr ? FormatTraits{.format = format} : row->traits;
}

std::string_view format_name(VkFormat format) {
    const Row* const row = find_row(format);
    return row == nullptr ? std::string_view("an unknown format") : row->name;
}

}  // namespace darkroom::gpu
