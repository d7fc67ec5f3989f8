// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <darkroom/effects/gaussian_blur.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "compose/test_stacks/support.hpp"
#include "gaussian_blur/gaussian_blur_reference.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

constexpr GaussianBlurResolution full = GaussianBlurResolution::Full;
constexpr GaussianBlur settings[] = {{.radius = 1},
                                     {.radius = 2},
                                     {.radius = 4},
                                     {.radius = 5, .sigma = 64},
                                     {.radius = 31, .resolution = full},
                                     {.radius = 64, .resolution = full},
                                     {.radius = 64, .sigma = 0.4f}};
constexpr GaussianBlur wide_settings[] = {{.radius = 8},  {.radius = 16},
                                          {.radius = 24}, {.radius = 29, .sigma = 10},
                                          {.radius = 64}, {.radius = 64, .sigma = 9}};

TEST(GaussianBlur, WeightsSumToOne) {
    for (const GaussianBlur& blur : settings) {
        const GaussianBlurTaps taps = gaussian_blur_taps(blur);
        double sum = taps.centre_weight;
        for (std::size_t i = 0; i < taps.count; ++i) sum += 2.0 * taps.weights[i];
        EXPECT_NEAR(sum, 1.0, 1e-6) << blur.radius;
        EXPECT_EQ(taps.count, static_cast<std::size_t>(blur.radius + 1) / 2);
    }
    for (const GaussianBlur& blur : wide_settings) {
        const std::vector<double> side = gaussian_blur_reference_weights(gaussian_blur_taps(blur, 4.0));
        EXPECT_NEAR(2 * std::accumulate(side.begin(), side.end(), 0.0) - side[0], 1.0, 1e-6) << blur.radius;
    }
    EXPECT_EQ(gaussian_blur_taps({.radius = 0}).count, 0u);
    EXPECT_EQ(gaussian_blur_taps({.radius = 0}).centre_weight, 1.0f);
}

TEST(GaussianBlur, BilinearTapsEqualTheNaiveSum) {
    for (const GaussianBlur& blur : settings) {
        const std::vector<double> naive = gaussian_blur_reference_weights(blur);
        const std::vector<double> taps = gaussian_blur_reference_weights(gaussian_blur_taps(blur));
        ASSERT_GE(taps.size(), naive.size());
        // A pair's weight and the fraction of it are floats below 1.
        for (std::size_t i = 0; i < naive.size(); ++i)
            EXPECT_NEAR(taps[i], naive[i], 0x1p-23) << blur.radius << " " << i;
        for (std::size_t i = naive.size(); i < taps.size(); ++i) EXPECT_EQ(taps[i], 0.0);
    }
}

TEST(GaussianBlur, ATapLiesWhereItsPairsWeightsMeet) {
    // exp(-1/2) and exp(-2): the offset of a tap from its nearer texel is W2 / (W1 + W2), its weight W1 + W2.
    const GaussianBlurTaps taps = gaussian_blur_taps({.radius = 2, .sigma = 1});
    const double near = std::exp(-0.5), far = std::exp(-2.0), sum = 1 + 2 * near + 2 * far;
    ASSERT_EQ(taps.count, 1u);
    EXPECT_FLOAT_EQ(taps.fractions[0], static_cast<float>(far / (near + far)));
    EXPECT_FLOAT_EQ(taps.weights[0], static_cast<float>((near + far) / sum));
    EXPECT_FLOAT_EQ(taps.centre_weight, static_cast<float>(1 / sum));
}

TEST(GaussianBlur, FetchesAreCounted) {
    // Per line 1 + 2 (radius + 1) / 2 taps for 2 radius + 1 weights.
    EXPECT_EQ(gaussian_blur_fetches({.radius = 4}), 2 * 5);
    EXPECT_EQ(gaussian_blur_fetches({.radius = 64, .resolution = full}), 2 * 65);
    // Two halvings by 4 taps, lines of 7 taps at a quarter, two doublings, and the alpha.
    EXPECT_EQ(gaussian_blur_fetches({.radius = 24}), 4 / 4.0 + 4 / 16.0 + 2 * 7 / 16.0 + 1 / 4.0 + 1 + 1);
}

TEST(GaussianBlur, OnlyWideBellsThatAreWholeUseASmallerPicture) {
    EXPECT_EQ(gaussian_blur_level({.radius = 0}), 0u);
    EXPECT_EQ(gaussian_blur_level({.radius = 7}), 0u);
    EXPECT_EQ(gaussian_blur_level({.radius = 8}), 1u);
    EXPECT_EQ(gaussian_blur_level({.radius = 24}), 2u);
    EXPECT_EQ(gaussian_blur_level({.radius = 64}), 4u);
    EXPECT_EQ(gaussian_blur_level({.radius = 64, .sigma = 22}), 4u);
    EXPECT_EQ(gaussian_blur_level({.radius = 64, .sigma = 22.5f}), 0u) << "its edge shows";
    EXPECT_EQ(gaussian_blur_level({.radius = 64, .resolution = full}), 0u);
}

/// The variance of one line of `image`, which holds one spot, in pixels.
double variance_of_line(const ReferenceImage& image, std::uint32_t y) {
    double sum = 0, first = 0, second = 0;
    for (std::uint32_t x = 0; x < image.width; ++x) {
        const double value = image.at(x, y).r;
        sum += value, first += value * x, second += value * x * x;
    }
    return second / sum - first * first / (sum * sum);
}

TEST(GaussianBlur, SmallerPicturesKeepTheVariance) {
    for (const GaussianBlur& blur : wide_settings) {
        // One spot on each place that a texel of the smallest picture covers; all together are one wider spot.
        const std::uint32_t texel = 1u << gaussian_blur_level(blur), width = 16 * texel * ((blur.radius + 63) / 16);
        ReferenceImage spots(width, 1);
        for (std::uint32_t i = 0; i < texel; ++i) spots.at(width / 2 + i, 0) = {1, 0, 0, 1};
        const double own = (texel * texel - 1) / 12.0;
        const double expected = variance_of_line(gaussian_blur_reference_naive(blur, spots), 0) - own;
        const double variance = variance_of_line(test::reference_of(blur, spots), 0) - own;
        // The taps are floats.
        EXPECT_NEAR(variance / expected, 1.0, 1e-5) << blur.radius << " " << blur.sigma;
    }
}

TEST(GaussianBlur, SmallerPicturesAreNearTheNaiveSum) {
    // What the page says: a code of 8 bits of a step, and 4 % of a lone pixel's peak, at any place of either in the
    // grid of the smallest picture.
    for (const GaussianBlur& blur : wide_settings) {
        const std::uint32_t texel = 1u << gaussian_blur_level(blur), side = texel * ((2 * blur.radius + 63) / texel);
        for (std::uint32_t place = 0; place < texel; place += (texel + 3) / 4) {
            ReferenceImage step(side, 1), spot(side, side);
            for (std::uint32_t x = side / 2 + place; x < side; ++x) step.at(x, 0) = {1, 1, 1, 1};
            EXPECT_LE(test::worst_difference(test::reference_of(blur, step), gaussian_blur_reference_naive(blur, step)),
                      1 / 255.0)
                << blur.radius << " " << place;
            if (blur.radius > 30) continue;
            spot.at(side / 2 + place, side / 2) = {1, 1, 1, 1};
            const ReferenceImage naive = gaussian_blur_reference_naive(blur, spot);
            EXPECT_LE(test::worst_difference(test::reference_of(blur, spot), naive),
                      0.04 * naive.at(side / 2 + place, side / 2).r)
                << blur.radius << " " << place;
        }
    }
}

TEST(GaussianBlur, ReferenceIsRoundAndKeepsFlatFields) {
    ReferenceImage spot(65, 65);
    spot.at(32, 32) = {1, 1, 1, 1};
    const ReferenceImage out = test::reference_of(GaussianBlur{.radius = 15, .resolution = full}, spot);
    // Equal distances: (3, 4), (5, 0); (6, 8), (10, 0).
    EXPECT_NEAR(out.at(35, 36).r / out.at(37, 32).r, 1.0, 1e-12);
    EXPECT_NEAR(out.at(38, 40).r / out.at(42, 32).r, 1.0, 1e-12);
    EXPECT_NEAR(out.at(37, 32).r / out.at(42, 32).r, std::exp(1.5), 1e-12) << "a bell of sigma 5, no square";
    const ReferenceImage flat = test::uniform(20, 12, {3, 2, 1, 0.25});
    EXPECT_LT(test::worst_difference(test::reference_of(GaussianBlur{.radius = 15, .resolution = full}, flat), flat),
              1e-12);
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

/// The largest excess over what rounding can explain. Writes in half precision, two and as many for each halving and
/// doubling, which the software driver cuts off toward zero: up to 2^-10 of the value each; with both signs in the
/// picture it is the sum of magnitudes that counts. And a bilinear tap's place is a float, so across a picture of up to
/// 64 pixels it is known to 2^-17 of one, which moves that much of the brightest pixel in reach. Where it is filtered,
/// it is known to filter_step: along a line in the two passes of the blur, in both directions when halving and
/// doubling.
double worst_excess(const GaussianBlur& blur, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = test::reference_of(blur, picture);
    ReferenceImage magnitude = picture;
    for (Rgba& color : magnitude.pixels) color = {std::abs(color.r), std::abs(color.g), std::abs(color.b), color.a};
    const ReferenceImage size = test::reference_of(blur, magnitude);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    const std::uint32_t level = gaussian_blur_level(blur), reach = blur.radius + (4u << level);
    const double writes = 2.0 + 2.0 * level;
    const double place = 0x1p-17 + (2.0 + 4.0 * level) * gpu::test::filter_step();
    double worst = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const double moved = largest_around(picture, x, y, reach) * place;
            const auto check = [&](double want, double got, double of) {
                const double allowed = of * writes * 0x1p-10 + moved + writes * 0x1p-23;
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

TEST(GaussianBlurGpu, SmallerPicturesMatchTheReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(61, 24, 22));
    for (const GaussianBlur& blur : wide_settings)
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(worst_excess(blur, picture, developed(blur, picture, kernels)), 1.0)
                << blur.radius << " " << blur.sigma;
    for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 17u}, {64u, 32u}}) {
        const ReferenceImage other = test::round_to_float(test::random_hdr(width, height, 23));
        EXPECT_LE(worst_excess({.radius = 24}, other, developed({.radius = 24}, other)), 1.0) << width << "x" << height;
    }
}

TEST(GaussianBlurGpu, RadiusZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 20, 2));
    EXPECT_EQ(test::worst_difference(developed({.radius = 0}, picture), picture), 0.0);
}

TEST(GaussianBlurGpu, SpotsAreRound) {
    ReferenceImage spot(65, 65);
    spot.at(32, 32) = {1000, 1000, 1000, 1};
    const ReferenceImage out = developed({.radius = 15, .resolution = full}, spot);
    ASSERT_EQ(out.pixels.size(), spot.pixels.size());
    EXPECT_NEAR(out.at(35, 36).r / out.at(37, 32).r, 1.0, 0x1p-8);
    EXPECT_NEAR(out.at(38, 40).r / out.at(42, 32).r, 1.0, 0x1p-8);
    EXPECT_NEAR(out.at(32, 37).r / out.at(37, 32).r, 1.0, 0x1p-8);
    EXPECT_NEAR(out.at(37, 32).r / out.at(42, 32).r / std::exp(1.5), 1.0, 0x1p-8) << "a bell of sigma 5, no square";
}

TEST(GaussianBlurGpu, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(64, 64, 4)), broken = picture;
    broken.at(30, 30) = {nan, infinity, -infinity, 1};
    for (const GaussianBlur& blur : {GaussianBlur{.radius = 6}, GaussianBlur{.radius = 13}}) {
        const ReferenceImage clean = developed(blur, picture), out = developed(blur, broken);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        const int reach = blur.radius + (gaussian_blur_level(blur) > 0 ? 4 : 1);
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x) {
                const Rgba& color = out.at(x, y);
                EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b))
                    << x << "," << y;
                EXPECT_TRUE(color.r >= 0.0 && color.r <= 1.0) << "NaN counts as black: " << x << "," << y;
                if (std::max(std::abs(int(x) - 30), std::abs(int(y) - 30)) > reach) {
                    EXPECT_EQ(color.r, clean.at(x, y).r);
                }
            }
    }
}

}  // namespace
}  // namespace darkroom
