// SPDX-License-Identifier: MIT
// How coarse a picture is while it moves, and what a stored frame is then.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "apps/viewer/preview_scale.hpp"
#include "apps/viewer/source/reduced_frame.hpp"

namespace app {
namespace {

/// Frames that take what `seconds` says of their divisor.
std::uint32_t after(PreviewScale& scale, int frames, const std::function<double(std::uint32_t)>& seconds) {
    for (int i = 0; i < frames; ++i) scale.add(seconds(scale.divisor()));
    return scale.divisor();
}
auto of_pixels(double whole) {
    return [whole](std::uint32_t divisor) { return whole / (divisor * divisor); };
}

TEST(PreviewScale, IsAsFineAsTimeAllows) {
    PreviewScale fast, slow, slowest;
    EXPECT_EQ(after(fast, 100, of_pixels(0.05)), 1U);
    EXPECT_EQ(after(slow, 100, of_pixels(0.2)), 2U);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.5)), 4U);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.1)), 2U);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.02)), 1U);
}

TEST(PreviewScale, OneFrameThatTakesLongChangesNothing) {
    PreviewScale scale;
    for (int i = 0; i < 100; ++i) scale.add(i % 5 == 0 ? 1.0 : 0.02);
    EXPECT_EQ(scale.divisor(), 1U);
}

TEST(PreviewScale, DoesNotAlternate) {
    for (const double whole : {0.05, 0.07, 0.1, 0.2, 0.26, 0.3, 0.5}) {
        PreviewScale scale;
        (void)after(scale, 50, of_pixels(whole));
        const std::uint32_t settled = scale.divisor();
        for (int i = 0; i < 100; ++i) EXPECT_EQ(after(scale, 1, of_pixels(whole)), settled) << whole;
    }
}

TEST(PreviewScale, KeepsThePixelsWhereFewerGainNothing) {
    PreviewScale scale;
    int coarse = 0;
    for (int i = 0; i < 200; ++i) coarse += after(scale, 1, [](std::uint32_t) { return 0.3; }) > 1 ? 1 : 0;
    EXPECT_EQ(scale.divisor(), 1U);
    EXPECT_LT(coarse, 10);
}

TEST(ReducedFrame, HasThePixelsInTheMiddleAndShorterMotion) {
    constexpr std::uint32_t width = 5, height = 3;
    std::vector<float> depth, velocity;
    std::vector<std::uint16_t> color;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            depth.push_back(static_cast<float>(10 * y + x));
            velocity.insert(velocity.end(), {static_cast<float>(x) / 3, -4});
            for (int i = 0; i < 4; ++i) color.push_back(static_cast<std::uint16_t>(100 * y + x));
        }
    darkroom::DevelopInput input{.extent = {width, height}, .depth = depth, .velocity = velocity};
    input.color_halves = color;
    const ReducedFrame reduced(input, 2);
    EXPECT_EQ(reduced.input().extent.width, 3U);
    EXPECT_EQ(reduced.input().extent.height, 2U);
    const darkroom::UploadLayers& layers = reduced.layers();
    const std::vector<float> expected{11, 13, 14, 21, 23, 24};
    EXPECT_TRUE(std::ranges::equal(layers[1].values, expected));
    EXPECT_EQ(layers[0].halves.size(), 6U * 4);
    EXPECT_EQ(layers[0].halves[4], 103);
    EXPECT_EQ(layers[0].format, darkroom::layers_of(input)[0].format);
    EXPECT_FLOAT_EQ(layers[3].values[0], 1.0F / 6);
    EXPECT_EQ(layers[3].values[1], -2);
}

TEST(ReducedFrame, HalvesOfMotionAreHalved) {
    // 1, -2^-14, the smallest number, infinity.
    const std::vector<std::uint16_t> velocity{0x3c00, 0x8400, 0x3c00, 0x8400, 0x0001, 0x7c00, 0x0001, 0x7c00};
    const std::vector<std::uint16_t> color(16);
    darkroom::DevelopInput input{.extent = {4, 1}};
    input.color_halves = color;
    input.velocity_halves = velocity;
    const ReducedFrame half(input, 2), quarter(input, 4);
    EXPECT_TRUE(std::ranges::equal(half.layers()[3].halves, std::vector<std::uint16_t>{0x3800, 0x8200, 0, 0x7c00}));
    EXPECT_TRUE(std::ranges::equal(quarter.layers()[3].halves, std::vector<std::uint16_t>{0, 0x7c00}));
}

}  // namespace
}  // namespace app
