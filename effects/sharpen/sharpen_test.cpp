// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/sharpen.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "sharpen/sharpen_reference.hpp"

namespace darkroom {
namespace {

constexpr double half_a_code = 0.5 / 65535;

ReferenceImage developed(const Sharpen& sharpen, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(sharpen); }, picture, {.kernels = kernels});
}

/// FsrRcasF of ffx_fsr1.h for a pixel in [0, 1] with whole divisions, as published: no span, no other peak.
double published(double b, double d, double e, double f, double h, double sharpness) {
    const double least = std::min({b, d, f, h}), most = std::max({b, d, f, h});
    const double hit_min = std::min(least, e) / (4 * most), hit_max = (1 - std::max(most, e)) / (4 * least - 4);
    const double lobe = std::max(-0.1875, std::min(std::max(-hit_min, hit_max), 0.0)) * std::exp2(-sharpness);
    return (lobe * (b + d + h + f) + e) / (4 * lobe + 1);
}

TEST(EffectSharpen, IsThePublishedFormulaWithinTheSpanOfThePixels) {
    // Grey, so that all channels agree on the lobe.
    ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (Rgba& pixel : picture.pixels) pixel.g = pixel.b = pixel.r;
    for (const float stops : {0.0f, -0.7f, -3.0f}) {
        const ReferenceImage out = developed({.stops = stops}, picture);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        int steeper = 0;
        for (std::int64_t y = 0; y < picture.height; ++y)
            for (std::int64_t x = 0; x < picture.width; ++x) {
                const double b = picture.clamped(x, y - 1).r, d = picture.clamped(x - 1, y).r,
                             e = picture.clamped(x, y).r, f = picture.clamped(x + 1, y).r,
                             h = picture.clamped(x, y + 1).r;
                const double least = std::min({b, d, e, f, h}), most = std::max({b, d, e, f, h});
                const double expected = published(b, d, e, f, h, -double{stops});
                EXPECT_NEAR(out.clamped(x, y).r, std::clamp(expected, least, most), half_a_code) << x << "," << y;
                steeper += expected > least && expected < most && expected != e ? 1 : 0;
            }
        EXPECT_GT(steeper, 500);
    }
}

TEST(EffectSharpen, FlatFieldsKeepTheirBitsAndRampsTheirSlope) {
    for (const double value : {0.0, 0.3, 1.0, 7.0, -0.5, 60000.0}) {
        const ReferenceImage flat = test::round_to_float(test::uniform(9, 7, {value, value / 3, value / 7, 0.25}));
        EXPECT_EQ(test::worst_difference(developed({.stops = 0}, flat), flat), 0) << value;
    }
    ReferenceImage ramp(64, 48);
    for (std::uint32_t y = 0; y < ramp.height; ++y)
        for (std::uint32_t x = 0; x < ramp.width; ++x) {
            const double value = 0.1 + x / 128.0 + y / 256.0;
            ramp.at(x, y) = {value, 1 - value, value / 2, 1};
        }
    const ReferenceImage out = developed({.stops = 0}, ramp);
    for (std::uint32_t y = 1; y + 1 < ramp.height; ++y)
        for (std::uint32_t x = 1; x + 1 < ramp.width; ++x) EXPECT_NEAR(out.at(x, y).g, ramp.at(x, y).g, half_a_code);
}

TEST(EffectSharpen, AnEdgeGetsSteeperAndHasNoHalo) {
    // An edge as a filter leaves it; in scene light ten times as bright, too.
    for (const double white : {0.9, 10.0}) {
        ReferenceImage edge(16, 8, {0, 0, 0, 1});
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 16; ++x) {
                const double value = x < 7 ? 0.1 : x == 7 ? 0.25 : x == 8 ? 0.75 : 0.9;
                edge.at(x, y) = {value * white, value * white, value * white, 1};
            }
        double before = 0.5 * white;
        for (const float stops : {-4.0f, -2.0f, -1.0f, 0.0f}) {
            const ReferenceImage out = developed({.stops = stops}, edge);
            const double step = out.at(8, 4).r - out.at(7, 4).r;
            EXPECT_GT(step, before) << stops;
            before = step;
            for (const Rgba& pixel : out.pixels) {
                EXPECT_GE(pixel.r, static_cast<float>(0.1 * white));
                EXPECT_LE(pixel.r, static_cast<float>(0.9 * white));
            }
        }
    }
}

TEST(EffectSharpen, GpuMatchesReference) {
    const ReferenceImage display = test::round_to_float(test::random_display(67, 41, 2));
    const ReferenceImage light = test::round_to_float(test::random_hdr(67, 41, 3));
    for (const float stops : {0.0f, -0.5f, -8.0f})
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const Sharpen sharpen{.stops = stops};
            EXPECT_LE(test::worst_difference(developed(sharpen, display, stage), test::reference_of(sharpen, display)),
                      half_a_code);
            // A quotient of differences of single precision: some 2^-21 of the brightest around.
            EXPECT_LE(test::worst_difference(developed(sharpen, light, stage), test::reference_of(sharpen, light)),
                      60000 * 0x1p-20);
        }
}

TEST(EffectSharpen, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        EXPECT_LE(test::worst_difference(developed({}, picture), test::reference_of(Sharpen{}, picture)), half_a_code)
            << width << "x" << height;
    }
}

TEST(EffectSharpen, GpuNanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(24, 24, 4));
    picture.at(6, 6) = {nan, nan, nan, 1};
    picture.at(15, 9) = {infinity, -infinity, infinity, 1};
    const ReferenceImage out = developed({.stops = 0}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::int64_t y = 0; y < 24; ++y)
        for (std::int64_t x = 0; x < 24; ++x) {
            const bool is_beside = std::abs(x - 6) + std::abs(y - 6) <= 1 || std::abs(x - 15) + std::abs(y - 9) <= 1;
            const Rgba& color = out.clamped(x, y);
            for (const double value : {color.r, color.g, color.b})
                EXPECT_TRUE(value >= (is_beside ? -65504 : 0) && value <= (is_beside ? 65504 : 1)) << x << "," << y;
        }
}

}  // namespace
}  // namespace darkroom
