// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <darkroom/effects/gaussian_blur.hpp>
#include <limits>
#include <vector>

#include "compose/test_support.hpp"
#include "gaussian_blur/gaussian_blur_reference.hpp"

namespace darkroom {
namespace {

constexpr GaussianBlur settings[] = {{.radius = 1},
                                     {.radius = 2},
                                     {.radius = 4},
                                     {.radius = 5, .sigma = 64},
                                     {.radius = 31},
                                     {.radius = 64},
                                     {.radius = 64, .sigma = 0.4f}};

TEST(GaussianBlur, WeightsSumToOne) {
    for (const GaussianBlur& blur : settings) {
        const GaussianBlurTaps taps = gaussian_blur_taps(blur);
        double sum = taps.centre_weight;
        for (std::size_t i = 0; i < taps.count; ++i) sum += 2.0 * taps.weights[i];
        EXPECT_NEAR(sum, 1.0, 1e-6) << blur.radius;
        EXPECT_EQ(taps.count, static_cast<std::size_t>(blur.radius + 1) / 2);
    }
    EXPECT_EQ(gaussian_blur_taps({.radius = 0}).count, 0u);
    EXPECT_EQ(gaussian_blur_taps({.radius = 0}).centre_weight, 1.0f);
}

TEST(GaussianBlur, BilinearTapsEqualTheNaiveSum) {
    for (const GaussianBlur& blur : settings) {
        const std::vector<double> naive = gaussian_blur_reference_weights(blur);
        const GaussianBlurTaps taps = gaussian_blur_taps(blur);
        std::vector<double> spread(naive.size() + 1, 0.0);
        spread[0] = taps.centre_weight;
        for (std::size_t i = 0; i < taps.count; ++i) {
            ASSERT_TRUE(std::isfinite(taps.offsets[i]));
            const double first = std::floor(taps.offsets[i]), fraction = taps.offsets[i] - first;
            const auto texel = static_cast<std::size_t>(first);
            ASSERT_LT(texel, naive.size());
            spread[texel] += taps.weights[i] * (1 - fraction);
            spread[texel + 1] += taps.weights[i] * fraction;
        }
        // The offset is a float of up to 64: its last place is 2^-18 of a texel.
        for (std::size_t i = 0; i < naive.size(); ++i)
            EXPECT_NEAR(spread[i], naive[i], 1e-7) << blur.radius << " " << i;
        EXPECT_NEAR(spread.back(), 0.0, 1e-7);
    }
}

TEST(GaussianBlur, ReferenceIsRoundAndKeepsFlatFields) {
    ReferenceImage spot(65, 65);
    spot.at(32, 32) = {1, 1, 1, 1};
    const ReferenceImage out = test::reference_of(GaussianBlur{.radius = 15}, spot);
    // Equal distances: (3, 4), (5, 0); (6, 8), (10, 0).
    EXPECT_NEAR(out.at(35, 36).r / out.at(37, 32).r, 1.0, 1e-12);
    EXPECT_NEAR(out.at(38, 40).r / out.at(42, 32).r, 1.0, 1e-12);
    const ReferenceImage flat = test::uniform(20, 12, {3, 2, 1, 0.25});
    EXPECT_LT(test::worst_difference(test::reference_of(GaussianBlur{.radius = 15}, flat), flat), 1e-12);
}

ReferenceImage developed(const GaussianBlur& blur, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(blur); }, picture, {.kernels = kernels});
}

/// Largest of the three colours' magnitudes within `reach` pixels along the line and across it.
double largest_around(const ReferenceImage& image, std::int64_t x, std::int64_t y, std::int64_t reach) {
    double largest = 0;
    for (std::int64_t j = -reach; j <= reach; ++j)
        for (std::int64_t i = -reach; i <= reach; ++i) {
            const Rgba& color = image.clamped(x + i, y + j);
            largest = std::max({largest, std::abs(color.r), std::abs(color.g), std::abs(color.b)});
        }
    return largest;
}

/// The largest excess over what rounding can explain. Two writes in half precision, which the software driver cuts off
/// toward zero: up to 2^-10 of the value each; with both signs in the picture it is the sum of magnitudes that counts.
/// And a bilinear tap's place is a float, so across a picture of up to 64 pixels it is known to 2^-17 of one, which
/// moves that much of the brightest pixel in reach. (GPUs know it to 2^-9 only.)
double worst_excess(const GaussianBlur& blur, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = test::reference_of(blur, picture);
    ReferenceImage magnitude = picture;
    for (Rgba& color : magnitude.pixels) color = {std::abs(color.r), std::abs(color.g), std::abs(color.b), color.a};
    const ReferenceImage size = test::reference_of(blur, magnitude);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    double worst = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const double moved = largest_around(picture, x, y, blur.radius + 1) * 0x1p-17;
            const auto check = [&](double want, double got, double of) {
                const double allowed = of * 0x1p-9 + moved + 0x1p-22;
                worst = std::max(worst, std::isfinite(got) ? std::abs(want - got) / allowed : 1e9);
            };
            const Rgba &want = expected.at(x, y), &got = gpu.at(x, y), &of = size.at(x, y);
            check(want.r, got.r, of.r);
            check(want.g, got.g, of.g);
            check(want.b, got.b, of.b);
            if (!(std::abs(want.a - got.a) <= of.a * 0x1p-9)) return 1e9;
        }
    return worst;
}

TEST(GaussianBlurGpu, MatchesTheReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(61, 24, 21));
    for (const GaussianBlur& blur : settings)
        EXPECT_LE(worst_excess(blur, picture, developed(blur, picture)), 1.0) << blur.radius << " " << blur.sigma;
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
        EXPECT_LE(worst_excess({.radius = 7}, picture, developed({.radius = 7}, picture, kernels)), 1.0);
}

TEST(GaussianBlurGpu, RadiusZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 20, 2));
    EXPECT_EQ(test::worst_difference(developed({.radius = 0}, picture), picture), 0.0);
}

TEST(GaussianBlurGpu, SpotsAreRound) {
    ReferenceImage spot(65, 65);
    spot.at(32, 32) = {1000, 1000, 1000, 1};
    const ReferenceImage out = developed({.radius = 15}, spot);
    ASSERT_EQ(out.pixels.size(), spot.pixels.size());
    EXPECT_NEAR(out.at(35, 36).r / out.at(37, 32).r, 1.0, 0x1p-8);
    EXPECT_NEAR(out.at(38, 40).r / out.at(42, 32).r, 1.0, 0x1p-8);
    EXPECT_NEAR(out.at(32, 37).r / out.at(37, 32).r, 1.0, 0x1p-8);
}

TEST(GaussianBlurGpu, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(64, 64, 4)), broken = picture;
    broken.at(30, 30) = {nan, infinity, -infinity, 1};
    const GaussianBlur blur{.radius = 6};
    const ReferenceImage clean = developed(blur, picture), out = developed(blur, broken);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const Rgba& color = out.at(x, y);
            EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b)) << x << "," << y;
            EXPECT_TRUE(color.r >= 0.0 && color.r <= 1.0) << "NaN counts as black: " << x << "," << y;
            if (std::max(std::abs(int(x) - 30), std::abs(int(y) - 30)) > 7) {
                EXPECT_EQ(color.r, clean.at(x, y).r);
            }
        }
}

}  // namespace
}  // namespace darkroom
