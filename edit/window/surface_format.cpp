// SPDX-License-Identifier: MIT
#include "window/surface_format.hpp"

#include <algorithm>
#include <array>

namespace darkroom::window {

namespace {

struct Known {
    VkFormat format;
    VkColorSpaceKHR space;
    ColorState color;
};
// The best first.
constexpr std::array<Known, 6> of_high_range{{
    {VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT, scrgb_color},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT, pq_color},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT, pq_color},
    {VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_HDR10_ST2084_EXT, pq_color},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_HLG_EXT, hlg_color},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_HLG_EXT, hlg_color},
}};

}  // namespace

std::optional<SurfaceChoice> choose_surface(std::span<const VkSurfaceFormatKHR> formats, DynamicRange wanted,
                                            float peak_nits) {
    if (formats.empty()) return std::nullopt;
    if (wanted == DynamicRange::High) {
        for (const Known& known : of_high_range) {
            const bool is_there = std::ranges::any_of(formats, [&](const VkSurfaceFormatKHR& of) {
                return of.format == known.format && of.colorSpace == known.space;
            });
            if (!is_there) continue;
            SurfaceChoice out{{known.format, known.space}, known.color};
            out.color.peak_nits = peak_nits;
            return out;
        }
    }
    const auto rank = [](const VkSurfaceFormatKHR& of) {
        if (of.colorSpace != VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return 3;
        if (of.format == VK_FORMAT_B8G8R8A8_UNORM || of.format == VK_FORMAT_R8G8B8A8_UNORM) return 0;
        if (of.format == VK_FORMAT_B8G8R8A8_SRGB || of.format == VK_FORMAT_R8G8B8A8_SRGB) return 1;
        return 2;
    };
    return SurfaceChoice{*std::ranges::min_element(formats, {}, rank), srgb_color};
}

VkHdrMetadataEXT hdr_metadata(const ColorState& color) {
    VkHdrMetadataEXT out{.sType = VK_STRUCTURE_TYPE_HDR_METADATA_EXT};
    switch (color.primaries) {
        case Primaries::Rec709:
            out.displayPrimaryRed = {0.64f, 0.33f};
            out.displayPrimaryGreen = {0.30f, 0.60f};
            out.displayPrimaryBlue = {0.15f, 0.06f};
            break;
        case Primaries::Rec2020:
            out.displayPrimaryRed = {0.708f, 0.292f};
            out.displayPrimaryGreen = {0.170f, 0.797f};
            out.displayPrimaryBlue = {0.131f, 0.046f};
            break;
        case Primaries::P3:
            out.displayPrimaryRed = {0.680f, 0.320f};
            out.displayPrimaryGreen = {0.265f, 0.690f};
            out.displayPrimaryBlue = {0.150f, 0.060f};
            break;
    }
    out.whitePoint = {0.3127f, 0.3290f};
    out.maxLuminance = color.peak_nits;
    out.minLuminance = 0;
    // Nothing is brighter; how bright a picture is on the whole is not known before it is made, which 0 says.
    out.maxContentLightLevel = color.peak_nits;
    out.maxFrameAverageLightLevel = 0;
    return out;
}

}  // namespace darkroom::window
