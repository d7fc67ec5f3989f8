// SPDX-License-Identifier: MIT
// What a host adds to its projection and its samplers for effects that gather frames.

#include <gtest/gtest.h>
#include <cmath>
#include <darkroom/composer.hpp>
#include <limits>
#include <set>
#include <vector>

namespace darkroom {
namespace {

TEST(Jitter, IsHaltonsSequenceAboutThePixelsCentre) {
    const std::array<std::array<float, 2>, 5> published{
        {{1.0F / 2, 1.0F / 3}, {1.0F / 4, 2.0F / 3}, {3.0F / 4, 1.0F / 9}, {1.0F / 8, 4.0F / 9}, {5.0F / 8, 7.0F / 9}}};
    for (std::size_t i = 0; i < published.size(); ++i) {
        EXPECT_FLOAT_EQ(Composer::jitter(i)[0], published[i][0] - 0.5F) << i;
        EXPECT_FLOAT_EQ(Composer::jitter(i)[1], published[i][1] - 0.5F) << i;
    }
}

TEST(Jitter, HasEightPlacesForEachPixelOfTheOutputAndBeginsAnew) {
    for (const auto& [scale, phases] :
         std::vector<std::pair<float, std::uint64_t>>{{1.0F, 8}, {1.5F, 18}, {1.7F, 23}, {2.0F, 32}, {3.0F, 72}}) {
        std::set<std::array<float, 2>> places;
        std::array<double, 2> mean{};
        for (std::uint64_t i = 0; i < phases; ++i) {
            const auto place = Composer::jitter(i, scale);
            places.insert(place);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                EXPECT_LE(std::abs(place[axis]), 0.5F);
                mean[axis] += double{place[axis]} / static_cast<double>(phases);
            }
            EXPECT_EQ(place, Composer::jitter(i + 1000 * phases, scale)) << i;
        }
        EXPECT_EQ(places.size(), phases) << scale;
        // A picture that stands still does not lean: a van der Corput sequence is off by less than log(n) / n.
        for (const double lean : mean) EXPECT_LT(std::abs(lean), 0.08) << scale;
    }
}

TEST(Jitter, TakesScalesBelowOneForOne) {
    for (const float scale : {0.5F, 0.0F, -2.0F, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(Composer::jitter(11, scale), Composer::jitter(3)) << scale;
        EXPECT_EQ(Composer::mip_bias(scale), 0) << scale;
    }
    EXPECT_TRUE(std::isfinite(Composer::mip_bias(std::numeric_limits<float>::infinity())));
}

TEST(Jitter, BiasesMipLevelsByTheScale) {
    EXPECT_FLOAT_EQ(Composer::mip_bias(2), -1);
    EXPECT_FLOAT_EQ(Composer::mip_bias(1.5F), -0.5849625F);
}

/// Where a point of the camera's space lies in the picture, in pixels, y down.
std::array<double, 2> seen(const Matrix& projection, const std::array<double, 3>& point, VkExtent2D extent,
                           bool is_y_down) {
    std::array<double, 4> clip{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            clip[row] += double{projection[4 * column + row]} * (column < 3 ? point[column] : 1.0);
    const double y = (is_y_down ? clip[1] : -clip[1]) / clip[3];
    return {(clip[0] / clip[3] + 1) / 2 * extent.width, (y + 1) / 2 * extent.height};
}

TEST(Jitter, MovesPicturesOfAnyProjectionByPixels) {
    const Matrix perspective{1.2F, 0, 0, 0, 0, 2.1F, 0, 0, 0.1F, -0.2F, 0, -1, 0, 0, 0.1F, 0},
        orthographic{0.3F, 0, 0, 0, 0, -0.4F, 0, 0, 0, 0, -0.01F, 0, 0.1F, 0.2F, 0.5F, 1};
    const VkExtent2D extent{640, 360};
    const std::array<float, 2> jitter{0.375F, -0.25F};
    for (const Matrix& projection : {perspective, orthographic})
        for (const bool is_y_down : {true, false})
            for (const std::array<double, 3>& point :
                 {std::array{0.0, 0.0, -1.0}, std::array{3.0, -2.0, -17.0}, std::array{-40.0, 9.0, -300.0}}) {
                const auto before = seen(projection, point, extent, is_y_down);
                const auto after = seen(jittered(projection, jitter, extent, is_y_down), point, extent, is_y_down);
                EXPECT_NEAR(after[0] - before[0], 0.375, 1e-4);
                EXPECT_NEAR(after[1] - before[1], -0.25, 1e-4);
            }
}

}  // namespace
}  // namespace darkroom
