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
    const Result<FrameFile> small = resize(frame_of(16, 8), 8, 2);
    ASSERT_TRUE(small) << small.error().text;
    EXPECT_EQ(small->color.width, 8u);
    EXPECT_EQ(small->color.height, 2u);
    for (const float value : small->color.pixels) EXPECT_NEAR(value, 0.5f, 1e-6f);
    EXPECT_EQ(*small->velocity->at(3, 1), 2.0f);
    EXPECT_EQ(small->velocity->at(3, 1)[1], 1.0f);
    EXPECT_EQ(*small->depth->at(3, 0), 7.0f) << "the nearest pixel, not a mean";
}

TEST(ImageResize, BrightPixelsGetNoDarkRings) {
    FrameFile frame = frame_of(9, 9);
    *frame.color.at(4, 4) = 10000.0f;
    for (const std::uint32_t size : {3u, 31u}) {
        const Result<FrameFile> out = resize(frame, size, size);
        ASSERT_TRUE(out);
        for (std::uint32_t i = 0; i < size * size; ++i) EXPECT_GE(out->color.pixels[i * 4], 0.499f);
    }
}

TEST(ImageResize, RefusesNothing) { EXPECT_FALSE(resize(frame_of(4, 4), 0, 4)); }

}  // namespace
}  // namespace darkroom
