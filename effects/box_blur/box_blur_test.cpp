// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/box_blur.hpp>
#include <limits>

#include "box_blur/box_blur_reference.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const BoxBlur& blur, const ReferenceImage& picture, KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(blur); }, picture, {.kernels = kernels});
}

/// What rounding can explain: a write in half precision a pass, which the software driver cuts off toward zero, up to
/// 2^-10 of the value, and of the magnitudes where signs differ; and a bilinear tap's place, a float, which across 64
/// pixels is known to 2^-17 of one.
double worst_excess(const BoxBlur& blur, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = test::reference_of(blur, picture);
    ReferenceImage magnitude = picture;
    double brightest = 0;
    for (Rgba& color : magnitude.pixels) {
        color = {std::abs(color.r), std::abs(color.g), std::abs(color.b), color.a};
        brightest = std::max({brightest, color.r, color.g, color.b});
    }
    const ReferenceImage size = test::reference_of(blur, magnitude);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &of = size.pixels[i];
        const auto check = [&](double w, double g, double m) {
            const double allowed = blur.iterations * (m * 0x1p-9 + brightest * 0x1p-17 + 0x1p-22);
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, of.r);
        check(want.g, got.g, of.g);
        check(want.b, got.b, of.b);
        if (!(std::abs(want.a - got.a) <= of.a * 0x1p-9)) return 1e9;
    }
    return worst;
}

TEST(EffectBoxBlur, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(61, 24, 31));
    for (const BoxBlur& blur : {BoxBlur{.radius = 1}, BoxBlur{.radius = 4}, BoxBlur{.radius = 7, .iterations = 3},
                                BoxBlur{.radius = 64}, BoxBlur{.radius = 0, .iterations = 2}})
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(worst_excess(blur, picture, developed(blur, picture, kernels)), 1.0)
                << blur.radius << " " << blur.iterations;
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 9u}, {8u, 3u}}) {
        const ReferenceImage small = test::round_to_float(test::random_hdr(width, height, 32));
        EXPECT_LE(worst_excess({.radius = 5}, small, developed({.radius = 5}, small)), 1.0) << width << "x" << height;
    }
}

TEST(EffectBoxBlur, ASpotIsASquareOfItsMean) {
    ReferenceImage spot(15, 15);
    spot.at(7, 7) = {49, 98, 0, 1};
    const ReferenceImage out = developed({.radius = 3}, spot);
    ASSERT_EQ(out.pixels.size(), spot.pixels.size());
    for (std::uint32_t y = 0; y < 15; ++y)
        for (std::uint32_t x = 0; x < 15; ++x) {
            const bool is_inside = x >= 4 && x <= 10 && y >= 4 && y <= 10;
            // Two writes cut off toward zero.
            EXPECT_NEAR(out.at(x, y).r, is_inside ? 1.0 : 0.0, 0x1p-9) << x << "," << y;
            EXPECT_NEAR(out.at(x, y).g, is_inside ? 2.0 : 0.0, 0x1p-8) << x << "," << y;
        }
}

TEST(EffectBoxBlur, ThreeIterationsAreNearlyABell) {
    ReferenceImage spot(101, 1);
    spot.at(50, 0) = {1, 1, 1, 1};
    const BoxBlur blur{.radius = 6, .iterations = 3};
    const ReferenceImage out = test::reference_of(blur, spot);
    const double variance = 3 * (13 * 13 - 1) / 12.0, peak = 1 / std::sqrt(2 * std::acos(-1.0) * variance);
    double measured = 0;
    for (std::uint32_t x = 0; x < 101; ++x) {
        const double distance = x - 50.0;
        measured += out.at(x, 0).r * distance * distance;
        EXPECT_NEAR(out.at(x, 0).r, peak * std::exp(-0.5 * distance * distance / variance), 0.07 * peak);
    }
    EXPECT_NEAR(measured, variance, 1e-9);
}

TEST(EffectBoxBlur, RadiusZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 20, 2));
    EXPECT_EQ(test::worst_difference(developed({.radius = 0}, picture), picture), 0.0);
}

TEST(EffectBoxBlur, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(40, 40, 4)), broken = picture;
    broken.at(20, 20) = {nan, infinity, -infinity, 1};
    const ReferenceImage clean = developed({.radius = 3}, picture), out = developed({.radius = 3}, broken);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::uint32_t y = 0; y < 40; ++y)
        for (std::uint32_t x = 0; x < 40; ++x) {
            const Rgba& color = out.at(x, y);
            EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b)) << x << "," << y;
            EXPECT_TRUE(color.r >= 0.0 && color.r <= 1.0) << "NaN counts as black: " << x << "," << y;
            if (std::max(std::abs(int(x) - 20), std::abs(int(y) - 20)) > 3) {
                EXPECT_EQ(color.r, clean.at(x, y).r);
            }
        }
}

}  // namespace
}  // namespace darkroom
