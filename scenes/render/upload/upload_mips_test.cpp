// SPDX-License-Identifier: MIT
#include "render/upload/upload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(RenderMips, MaskedTexturesKeepTheirCoverage) {
    // One pixel in five, here and there: a mean alpha of 0.2, which reaches the cutoff nowhere after two levels.
    const auto grass = picture(80, 64, [](std::uint32_t x, std::uint32_t y) {
        return (x * 2654435761U ^ y * 2246822519U) % 1021 % 5 == 0 ? 255 : 0;
    });
    constexpr float cutoff = 0.5F;
    const auto covered = [](const MipLevel& level) {
        std::size_t count = 0;
        for (std::size_t i = 3; i < level.rgba.size(); i += 4) count += level.rgba[i] >= 128 ? 1 : 0;
        return static_cast<double>(count) / (level.width * level.height);
    };
    const std::vector<MipLevel> plain = mip_levels(80, 64, grass, true), kept = mip_levels(80, 64, grass, true, cutoff);
    ASSERT_EQ(kept.size(), plain.size());
    EXPECT_LT(covered(plain[2]), 0.02);
    // Of few alphas that there are one is the nearest.
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(covered(kept[i]), 0.2, 0.06) << i;
    // A smooth edge has a pixel for every share.
    const auto leaf = picture(64, 64, [](std::uint32_t x, std::uint32_t y) {
        return std::clamp(255 - 7 * std::hypot(x - 31.5, y - 31.5) + 64 * ((x + y) % 2), 0.0, 255.0);
    });
    std::size_t first = 0;
    for (std::size_t i = 3; i < leaf.size(); i += 4) first += leaf[i] >= 128 ? 1 : 0;
    const std::vector<MipLevel> leaves = mip_levels(64, 64, leaf, true, cutoff);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(covered(leaves[i]), static_cast<double>(first) / (64 * 64), 0.07) << i;
    // Colour is left alone.
    const std::vector<MipLevel> unscaled = mip_levels(64, 64, leaf, true);
    for (std::size_t i = 0; i < leaves[0].rgba.size(); ++i) {
        if (i % 4 != 3) {
            ASSERT_EQ(leaves[0].rgba[i], unscaled[0].rgba[i]);
        }
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
