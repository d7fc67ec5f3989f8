// SPDX-License-Identifier: MIT
#include "gpu/resource/formats.hpp"

#include <gtest/gtest.h>

#include <array>

namespace darkroom::gpu {

namespace {

constexpr VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
constexpr VkImageAspectFlags depth = VK_IMAGE_ASPECT_DEPTH_BIT;
constexpr VkImageAspectFlags stencil = VK_IMAGE_ASPECT_STENCIL_BIT;

TEST(Formats, AspectsAreThoseOfTheSpecification) {
    struct Case {
        VkFormat format;
        VkImageAspectFlags all;
        VkImageAspectFlags sampled;
    };
    constexpr std::array cases{
        Case{VK_FORMAT_D16_UNORM, depth, depth},
        Case{VK_FORMAT_X8_D24_UNORM_PACK32, depth, depth},
        Case{VK_FORMAT_D32_SFLOAT, depth, depth},
        Case{VK_FORMAT_S8_UINT, stencil, stencil},
        Case{VK_FORMAT_D16_UNORM_S8_UINT, depth | stencil, depth},
        Case{VK_FORMAT_D24_UNORM_S8_UINT, depth | stencil, depth},
        Case{VK_FORMAT_D32_SFLOAT_S8_UINT, depth | stencil, depth},
        Case{VK_FORMAT_R8_UINT, color, color},
        Case{VK_FORMAT_R32_SFLOAT, color, color},
        Case{VK_FORMAT_BC7_SRGB_BLOCK, color, color},
    };
    for (const Case& expected : cases) {
        EXPECT_EQ(format_traits(expected.format).aspects, expected.all) << format_name(expected.format);
        EXPECT_EQ(sampled_aspect(expected.format), expected.sampled) << format_name(expected.format);
        EXPECT_EQ(is_depth(expected.format), (expected.all & depth) != 0) << format_name(expected.format);
        EXPECT_EQ(has_stencil(expected.format), (expected.all & stencil) != 0) << format_name(expected.format);
    }
}

TEST(Formats, FloatAndSrgbAreToldApartFromNormalised) {
    for (const VkFormat format :
         {VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
          VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, VK_FORMAT_D32_SFLOAT}) {
        EXPECT_TRUE(format_traits(format).is_float) << format_name(format);
        EXPECT_FALSE(format_traits(format).is_srgb) << format_name(format);
    }
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_A8B8G8R8_SRGB_PACK32}) {
        EXPECT_TRUE(format_traits(format).is_srgb) << format_name(format);
        EXPECT_FALSE(format_traits(format).is_float) << format_name(format);
        EXPECT_TRUE(format_traits(format).glsl_qualifier.empty()) << "no storage image is sRGB";
    }
    EXPECT_FALSE(format_traits(VK_FORMAT_R8G8B8A8_UNORM).is_float);
    EXPECT_FALSE(format_traits(VK_FORMAT_D16_UNORM).is_float);
}

TEST(Formats, NumbersAreSeenByShadersAsTheyAreStored) {
    EXPECT_EQ(format_traits(VK_FORMAT_R16G16_SINT).numeric, Numeric::Signed);
    EXPECT_EQ(format_traits(VK_FORMAT_A2B10G10R10_UINT_PACK32).numeric, Numeric::Unsigned);
    EXPECT_EQ(format_traits(VK_FORMAT_R8G8B8A8_SNORM).numeric, Numeric::Float);
    EXPECT_EQ(format_traits(VK_FORMAT_D24_UNORM_S8_UINT).numeric, Numeric::Float)
        << "its depth is read, not its stencil";
    EXPECT_EQ(format_traits(VK_FORMAT_R16G16_SINT).glsl_qualifier, "rg16i");
    EXPECT_EQ(format_traits(VK_FORMAT_R16G16_SINT).bits, 32U);
}

// All of vulkan_core.h whose names end so; the signed one follows each.
TEST(Formats, NoIntegersPassForColour) {
    for (const VkFormat format : {VK_FORMAT_R8_UINT,
                                  VK_FORMAT_R8G8_UINT,
                                  VK_FORMAT_R8G8B8_UINT,
                                  VK_FORMAT_B8G8R8_UINT,
                                  VK_FORMAT_R8G8B8A8_UINT,
                                  VK_FORMAT_B8G8R8A8_UINT,
                                  VK_FORMAT_A8B8G8R8_UINT_PACK32,
                                  VK_FORMAT_A2R10G10B10_UINT_PACK32,
                                  VK_FORMAT_A2B10G10R10_UINT_PACK32,
                                  VK_FORMAT_R16_UINT,
                                  VK_FORMAT_R16G16_UINT,
                                  VK_FORMAT_R16G16B16_UINT,
                                  VK_FORMAT_R16G16B16A16_UINT,
                                  VK_FORMAT_R32_UINT,
                                  VK_FORMAT_R32G32_UINT,
                                  VK_FORMAT_R32G32B32_UINT,
                                  VK_FORMAT_R32G32B32A32_UINT,
                                  VK_FORMAT_R64_UINT,
                                  VK_FORMAT_R64G64_UINT,
                                  VK_FORMAT_R64G64B64_UINT,
                                  VK_FORMAT_R64G64B64A64_UINT}) {
        EXPECT_EQ(format_traits(format).numeric, Numeric::Unsigned) << format;
        EXPECT_EQ(format_traits(static_cast<VkFormat>(format + 1)).numeric, Numeric::Signed) << format + 1;
    }
}

TEST(Formats, WhatIsNotInTheListIsColourWithoutStorage) {
    const FormatTraits traits = format_traits(VK_FORMAT_BC1_RGB_UNORM_BLOCK);
    EXPECT_EQ(traits.format, VK_FORMAT_BC1_RGB_UNORM_BLOCK);
    EXPECT_EQ(traits.bits, 0U);
    EXPECT_TRUE(traits.glsl_qualifier.empty());
    EXPECT_EQ(format_name(VK_FORMAT_BC1_RGB_UNORM_BLOCK), "an unknown format");
}

}  // namespace

}  // namespace darkroom::gpu
