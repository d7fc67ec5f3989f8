// SPDX-License-Identifier: MIT
#include "image/picture/resize.hpp"

#include <gtest/gtest.h>

namespace darkroom {
namespace {

FrameFile frame_of(std::uint32_t width, std::uint32_t height) {
    FrameFile frame;
    frame.color = Picture(width, height);
    std::fill(frame.color.pixels.begin(), frame.color.pixels.end(), 0.5f);
    frame.depth = Plane<1>(width, height);
    for (std::uint32_t x = 0; x < width; ++x)
        for (std::uint32_t y = 0; y < height; ++y) *frame.depth->at(x, y) = static_cast<float>(x);
    frame.velocity = Plane<2>(width, height);
    std::fill(frame.velocity->values.begin(), frame.velocity->values.end(), 4.0f);
    return frame;
}

TEST(ImageResize, KeepsAnEvenPictureAndScalesMotion) {
    FrameFile frame = frame_of(16, 8);
    frame.camera.jitter = {0.5f, -0.5f};
    frame.camera.previous_jitter = {0.25f, 0.25f};
    const Result<FrameFile> small = resize(frame, {8, 2});
    ASSERT_TRUE(small) << small.error().text;
    EXPECT_EQ(small->color.width, 8u);
    EXPECT_EQ(small->color.height, 2u);
    for (const float value : small->color.pixels) EXPECT_NEAR(value, 0.5f, 1e-6f);
    EXPECT_EQ(*small->velocity->at(3, 1), 2.0f);
    EXPECT_EQ(small->velocity->at(3, 1)[1], 1.0f);
    EXPECT_EQ(small->camera.jitter, (std::array{0.25f, -0.125f}));
    EXPECT_EQ(small->camera.previous_jitter, (std::array{0.125f, 0.0625f}));
    EXPECT_EQ(*small->depth->at(3, 0), 7.0f) << "the nearest pixel, not a mean";
}

TEST(ImageResize, BrightPixelsGetNoDarkRings) {
    FrameFile frame = frame_of(9, 9);
    *frame.color.at(4, 4) = 10000.0f;
    for (const std::uint32_t size : {3u, 31u}) {
        const Result<FrameFile> out = resize(frame, {size, size});
        ASSERT_TRUE(out);
        for (std::uint32_t i = 0; i < size * size; ++i) EXPECT_GE(out->color.pixels[i * 4], 0.499f);
    }
}

TEST(ImageResize, FitsIntoASizeOfAnotherRatio) {
    const Result<FrameFile> out = resize(frame_of(16, 9), {128, 128, Sizing::Fit});
    ASSERT_TRUE(out);
    EXPECT_EQ(out->color.width, 128u);
    EXPECT_EQ(out->color.height, 72u);
    EXPECT_EQ(*out->velocity->at(3, 1), 32.0f);
    EXPECT_EQ(out->velocity->at(3, 1)[1], 32.0f);
}

// The projection of a point is where its pixel went.
TEST(ImageResize, FillsASizeOfAnotherRatioAndNarrowsTheCamera) {
    for (const std::uint32_t width : {16u, 17u}) {
        FrameFile frame = frame_of(width, 8);
        frame.camera.projection = perspective(60, width / 8.0);
        const Matrix before = *frame.camera.projection;
        const Result<FrameFile> out = resize(std::move(frame), {8, 8, Sizing::Fill});
        ASSERT_TRUE(out);
        EXPECT_EQ(out->color.width, 8u);
        EXPECT_EQ(out->color.height, 8u);
        EXPECT_EQ(*out->depth->at(0, 0), 4.0f) << "the middle of the width";
        EXPECT_EQ(*out->velocity->at(3, 1), 4.0f);
        const Matrix& after = *out->camera.projection;
        // A point at x = 0.3, z = -1, whose w is 1.
        const auto pixel = [](const Matrix& m, double side) {
            return (0.5 + 0.5 * (0.3 * double{m[0]} - double{m[8]})) * side;
        };
        EXPECT_NEAR(pixel(after, 8), pixel(before, width) - 4, 1e-5);
        EXPECT_EQ(after[5], before[5]);
    }
}

TEST(ImageResize, RefusesNothing) { EXPECT_FALSE(resize(frame_of(4, 4), {0, 4})); }

}  // namespace
}  // namespace darkroom
