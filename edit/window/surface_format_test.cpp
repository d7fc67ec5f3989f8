// SPDX-License-Identifier: MIT
#include "window/surface_format.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace darkroom::window {
namespace {

constexpr VkSurfaceFormatKHR unorm{VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
constexpr VkSurfaceFormatKHR srgb{VK_FORMAT_B8G8R8A8_SRGB, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
constexpr VkSurfaceFormatKHR ten_bits{VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
constexpr VkSurfaceFormatKHR scrgb{VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT};
constexpr VkSurfaceFormatKHR pq{VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT};
constexpr VkSurfaceFormatKHR pq_of_8_bits{VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_HDR10_ST2084_EXT};
constexpr VkSurfaceFormatKHR hlg{VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_HLG_EXT};

void expect_choice(const std::vector<VkSurfaceFormatKHR>& formats, DynamicRange wanted, VkSurfaceFormatKHR format,
                   const ColorState& color) {
    const std::optional<SurfaceChoice> choice = choose_surface(formats, wanted, 800);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->format.format, format.format);
    EXPECT_EQ(choice->format.colorSpace, format.colorSpace);
    EXPECT_EQ(choice->color, color);
}

ColorState up_to_800(ColorState color) {
    color.peak_nits = 800;
    return color;
}

TEST(WindowSurface, StandardRangeTakesWhatShowsEncodedPicturesAsTheyAre) {
    for (const DynamicRange wanted : {DynamicRange::Standard, DynamicRange::High}) {
        expect_choice({srgb, unorm}, wanted, unorm, srgb_color);
        expect_choice({ten_bits, srgb}, wanted, srgb, srgb_color);
        expect_choice({pq_of_8_bits, ten_bits}, wanted, ten_bits, srgb_color);
    }
    expect_choice({scrgb, pq, unorm}, DynamicRange::Standard, unorm, srgb_color);
    EXPECT_FALSE(choose_surface({}, DynamicRange::High, 1000));
}

TEST(WindowSurface, HighRangeTakesTheBestThatIsThere) {
    expect_choice({unorm, hlg}, DynamicRange::High, hlg, up_to_800(hlg_color));
    expect_choice({unorm, hlg, pq}, DynamicRange::High, pq, up_to_800(pq_color));
    expect_choice({unorm, hlg, pq, scrgb}, DynamicRange::High, scrgb, up_to_800(scrgb_color));
}

TEST(WindowSurface, ADisplayIsToldThePrimariesAndThePeak) {
    const VkHdrMetadataEXT told = hdr_metadata(up_to_800(pq_color));
    EXPECT_EQ(told.sType, VK_STRUCTURE_TYPE_HDR_METADATA_EXT);
    EXPECT_EQ(told.displayPrimaryRed.x, 0.708f);
    EXPECT_EQ(told.displayPrimaryGreen.y, 0.797f);
    EXPECT_EQ(told.displayPrimaryBlue.x, 0.131f);
    EXPECT_EQ(told.whitePoint.x, 0.3127f);
    EXPECT_EQ(told.maxLuminance, 800);
    EXPECT_EQ(told.maxContentLightLevel, 800);
    EXPECT_EQ(hdr_metadata(scrgb_color).displayPrimaryRed.x, 0.64f);
}

}  // namespace
}  // namespace darkroom::window
