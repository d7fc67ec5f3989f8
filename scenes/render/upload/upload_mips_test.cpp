// SPDX-License-Identifier: MIT
#include "render/upload/upload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace darkroom::render {
namespace {

std::vector<std::uint8_t> picture(std::uint32_t width, std::uint32_t height, auto value) {
    std::vector<std::uint8_t> rgba;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto byte = static_cast<std::uint8_t>(value(x, y));
            rgba.insert(rgba.end(), {byte, byte, byte, byte});
        }
    }
    return rgba;
}

TEST(RenderMips, LevelsHalveDownToOnePixel) {
    const auto grey = picture(13, 6, [](std::uint32_t, std::uint32_t) { return 77; });
    const std::vector<MipLevel> levels = mip_levels(13, 6, grey, true);
    ASSERT_EQ(levels.size(), 3U);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{6, 3}, {3, 1}, {1, 1}};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        EXPECT_EQ(levels[i].width, sizes[i].first);
        EXPECT_EQ(levels[i].height, sizes[i].second);
        ASSERT_EQ(levels[i].rgba.size(), std::size_t{sizes[i].first} * sizes[i].second * 4);
        for (const std::uint8_t byte : levels[i].rgba) EXPECT_EQ(byte, 77) << "what is even stays so";
    }
    EXPECT_TRUE(mip_levels(1, 1, std::vector<std::uint8_t>(4), false).empty());
}

TEST(RenderMips, EncodedColoursAreAveragedAsLightAndAlphaIsNot) {
    const auto checker = picture(2, 2, [](std::uint32_t x, std::uint32_t y) { return (x + y) % 2 * 255; });
    EXPECT_EQ(mip_levels(2, 2, checker, true)[0].rgba, (std::vector<std::uint8_t>{188, 188, 188, 128}));
    EXPECT_EQ(mip_levels(2, 2, checker, false)[0].rgba, (std::vector<std::uint8_t>{128, 128, 128, 128}));
}

TEST(RenderMips, OddSizesKeepTheMean) {
    for (const std::uint32_t width : {3U, 5U, 7U, 31U}) {
        const auto ramp = picture(width, 1, [&](std::uint32_t x, std::uint32_t) { return 240 * x / (width - 1); });
        double sum = 0;
        for (std::uint32_t x = 0; x < width; ++x) sum += ramp[4 * x];
        const std::vector<MipLevel> levels = mip_levels(width, 1, ramp, false);
        EXPECT_NEAR(levels.back().rgba[0], sum / width, width == 3 ? 1.0 : 3.0) << width;
        const MipLevel& first = levels[0];
        double half_sum = 0;
        for (std::uint32_t x = 0; x < first.width; ++x) half_sum += first.rgba[4 * x];
        EXPECT_NEAR(half_sum / first.width, sum / width, 1) << width << ": every pixel weighs the same";
    }
}

/// Alpha where a sampler filters it; `x` and `y` from 0 to 1.
double filtered(const MipLevel& level, double x, double y) {
    const double column = x * level.width - 0.5 + level.width, row = y * level.height - 0.5 + level.height;
    const auto alpha = [&](int i, int j) {
        const auto u = static_cast<std::uint32_t>(column + i) % level.width;
        const auto v = static_cast<std::uint32_t>(row + j) % level.height;
        return level.rgba[(std::size_t{v} * level.width + u) * 4 + 3] / 255.0;
    };
    const double across = column - std::floor(column), down = row - std::floor(row);
    return std::lerp(std::lerp(alpha(0, 0), alpha(1, 0), across), std::lerp(alpha(0, 1), alpha(1, 1), across), down);
}

/// Share that reaches the cutoff at distances from that of one level to that of the next, evenly.
double covered(const MipLevel& finer, const MipLevel& level, double cutoff) {
    constexpr int side = 301;
    int count = 0;
    for (int i = 0; i < side * side; ++i) {
        const double x = (i % side + 0.5) / side, y = (i / side + 0.5) / side;
        const double near = filtered(finer, x, y), far = filtered(level, x, y);
        for (const double mixture : {0.1, 0.3, 0.5, 0.7, 0.9}) count += std::lerp(near, far, mixture) >= cutoff;
    }
    return count / (5.0 * side * side);
}

TEST(RenderMips, WhatIsCutOutKeepsItsCoverage) {
    // One pixel in five, here and there: a mean alpha of 0.2, which reaches the cutoff nowhere after two levels. A leaf
    // with a smooth edge. A hedge, most of which is left.
    const auto grass = picture(80, 64, [](std::uint32_t x, std::uint32_t y) {
        return (x * 2654435761U ^ y * 2246822519U) % 1021 % 5 == 0 ? 255 : 0;
    });
    const auto leaf = picture(80, 64, [](std::uint32_t x, std::uint32_t y) {
        return std::clamp(255 - 7 * std::hypot(x - 31.5, y - 31.5) + 64 * ((x + y) % 2), 0.0, 255.0);
    });
    const auto hedge = picture(80, 64, [](std::uint32_t x, std::uint32_t y) {
        return (x * 2654435761U ^ y * 2246822519U) % 1021 % 5 == 0 ? 0 : 255;
    });
    for (const std::vector<std::uint8_t>& rgba : {grass, leaf, hedge})
        for (const float cutoff : {0.1F, 0.5F, 0.8F}) {
            const std::vector<MipLevel> levels = mip_levels(80, 64, rgba, true, {.weighs = true, .cutoff = cutoff});
            ASSERT_EQ(levels[0].width, 80U);
            const double wanted = covered(levels[0], levels[0], cutoff);
            for (std::size_t i = 1; i < 4; ++i)
                // At low cutoffs a code of 8 bits is a share of some 0.04: alphas of small levels differ by few.
                EXPECT_NEAR(covered(levels[i - 1], levels[i], cutoff), wanted, 0.05) << i << ", cutoff " << cutoff;
        }
    const MipLevel third = mip_levels(80, 64, grass, true)[2];
    EXPECT_LT(covered(third, third, 0.5), 0.02) << "else it is gone";
}

// Red leaves over holes that are black, white or green: in no level is there any of what is not seen.
TEST(RenderMips, ColourUnderHolesIsThatOfWhatIsSeen) {
    for (const std::array<std::uint8_t, 3>& under : {std::array<std::uint8_t, 3>{}, {255, 255, 255}, {0, 255, 0}}) {
        std::vector<std::uint8_t> rgba;
        for (std::uint32_t i = 0; i < 37 * 24; ++i) {
            const bool is_leaf = i % 37 < 9 && i / 37 % 5 < 2;
            const std::array<std::uint8_t, 3> color = is_leaf ? std::array<std::uint8_t, 3>{200, 30, 10} : under;
            rgba.insert(rgba.end(), color.begin(), color.end());
            rgba.push_back(is_leaf ? 255 : 0);
        }
        const std::vector<MipLevel> levels = mip_levels(37, 24, rgba, true, {.weighs = true});
        ASSERT_EQ(levels.size(), 6U);
        for (const MipLevel& level : levels)
            for (std::size_t i = 0; i < level.rgba.size(); i += 4) {
                ASSERT_NEAR(level.rgba[i], 200, 1) << level.width;
                ASSERT_NEAR(level.rgba[i + 1], 30, 1);
                ASSERT_NEAR(level.rgba[i + 2], 10, 1);
            }
        // Where alpha is no cover, colour is what it is.
        EXPECT_NE(mip_levels(37, 24, rgba, true).back().rgba[0], 200);
        scene::Image wide{.width = 37, .height = 24, .kind = scene::ImageKind::Codes16};
        for (const std::uint8_t code : rgba) wide.wide.push_back(static_cast<std::uint16_t>(code * 257));
        for (const WideMipLevel& level : wide_mip_levels(wide, false, true, {.weighs = true}))
            for (std::size_t i = 0; i < level.rgba.size(); i += 4) ASSERT_NEAR(level.rgba[i], 200 * 257, 2);
    }
}

TEST(RenderMips, WideLevelsAreMeansOfLight) {
    scene::Image image{.width = 2,
                       .height = 1,
                       .wide = {0, 0x8040, 0x8000, 0xffff, 0xffff, 0x8040, 0x8002, 1},
                       .kind = scene::ImageKind::Codes16};
    // Half of the light, and not what the mean of the codes decodes to (0.214).
    std::vector<WideMipLevel> levels = wide_mip_levels(image, true, false);
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_NEAR(glm::unpackHalf1x16(levels[1].rgba[0]), 0.5F, 1e-3F);
    EXPECT_NEAR(glm::unpackHalf1x16(levels[1].rgba[1]), 0.21495F, 1e-4F);
    EXPECT_NEAR(glm::unpackHalf1x16(levels[1].rgba[3]), 0.5F, 1e-3F);
    levels = wide_mip_levels(image, false, true);
    EXPECT_EQ(levels[0].rgba, image.wide);
    EXPECT_EQ(levels[1].rgba, (std::vector<std::uint16_t>{0x8000, 0x8040, 0x8001, 0x8000}));
    image.kind = scene::ImageKind::Halves;
    for (std::size_t i = 0; i < 8; ++i) image.wide[i] = glm::packHalf1x16(i < 4 ? 12.0F : 2.0F);
    levels = wide_mip_levels(image, true, false);
    EXPECT_EQ(levels[0].rgba, image.wide);
    EXPECT_EQ(glm::unpackHalf1x16(levels[1].rgba[0]), 7);
}

TEST(RenderMips, EveryCodeSurvivesDecodingAndEncoding) {
    for (int code = 0; code < 256; ++code) {
        const auto flat = picture(2, 1, [&](std::uint32_t, std::uint32_t) { return code; });
        EXPECT_EQ(mip_levels(2, 1, flat, true)[0].rgba[0], code);
    }
}

}  // namespace
}  // namespace darkroom::render
