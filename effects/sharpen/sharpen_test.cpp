// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// CasFilter of ffx_cas.h for a pixel in [0, 1] with better diagonals, as published: a b c, d e f, g h i. `peak` is
/// what the sharpness makes of it, -1/8 at 0 and -1/5 at 1.
double published_cas(const std::array<double, 9>& p, double peak) {
    const auto [a, b, c, d, e, f, g, h, i] = p;
    double mn = std::min({d, e, f, b, h}), mx = std::max({d, e, f, b, h});
    mn += std::min({mn, a, c, g, i}), mx += std::max({mx, a, c, g, i});
    const double amp = std::sqrt(std::clamp(std::min(mn, 2 - mx) / mx, 0.0, 1.0)), w = amp * peak;
    return std::clamp((b * w + d * w + f * w + h * w + e) / (1 + 4 * w), 0.0, 1.0);
}

TEST(EffectSharpen, CasIsThePublishedFormulaWithinTheSpanOfThePixels) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 6));
    // Sharpness 1, 1/2 and 0 of the published code, as stops.
    for (const double peak : {-1.0 / 5, -1.0 / 6.5, -1.0 / 8}) {
        const Sharpen sharpen{.mode = SharpenMode::Cas, .stops = static_cast<float>(std::log2(-5 * peak))};
        const ReferenceImage out = developed(sharpen, picture);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        int steeper = 0;
        for (std::int64_t y = 0; y < picture.height; ++y)
            for (std::int64_t x = 0; x < picture.width; ++x) {
                std::array<double, 9> p{};
                for (std::int64_t k = 0; k < 9; ++k)
                    p[static_cast<std::size_t>(k)] = picture.clamped(x + k % 3 - 1, y + k / 3 - 1).b;
                const double least = std::min({p[1], p[3], p[4], p[5], p[7]}),
                             most = std::max({p[1], p[3], p[4], p[5], p[7]}), expected = published_cas(p, peak);
                EXPECT_NEAR(out.clamped(x, y).b, std::clamp(expected, least, most), half_a_code) << x << "," << y;
                steeper += expected > least && expected < most && expected != p[4] ? 1 : 0;
            }
        EXPECT_GT(steeper, 500);
    }
}

constexpr std::array both_modes{SharpenMode::Rcas, SharpenMode::Cas};

TEST(EffectSharpen, FlatFieldsKeepTheirBitsAndRampsTheirSlope) {
    for (const double value : {0.0, 0.3, 1.0, 7.0, -0.5, 60000.0}) {
        const ReferenceImage flat = test::round_to_float(test::uniform(9, 7, {value, value / 3, value / 7, 0.25}));
        for (const SharpenMode mode : both_modes)
            EXPECT_EQ(test::worst_difference(developed({.mode = mode, .stops = 0}, flat), flat), 0) << value;
    }
    ReferenceImage ramp(64, 48);
    for (std::uint32_t y = 0; y < ramp.height; ++y)
        for (std::uint32_t x = 0; x < ramp.width; ++x) {
            const double value = 0.1 + x / 128.0 + y / 256.0;
            ramp.at(x, y) = {value, 1 - value, value / 2, 1};
        }
    for (const SharpenMode mode : both_modes) {
        const ReferenceImage out = developed({.mode = mode, .stops = 0}, ramp);
        for (std::uint32_t y = 1; y + 1 < ramp.height; ++y)
            for (std::uint32_t x = 1; x + 1 < ramp.width; ++x)
                EXPECT_NEAR(out.at(x, y).g, ramp.at(x, y).g, half_a_code);
    }
}

TEST(EffectSharpen, AnEdgeGetsSteeperAndHasNoHalo) {
    // An edge as a filter leaves it; in scene light ten times as bright, too.
    for (const auto& [mode, white] : {std::pair{SharpenMode::Rcas, 0.9},
                                      {SharpenMode::Rcas, 10.0},
                                      {SharpenMode::Cas, 0.9},
                                      {SharpenMode::Cas, 10.0}}) {
        ReferenceImage edge(16, 8, {0, 0, 0, 1});
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 16; ++x) {
                const double value = x < 7 ? 0.1 : x == 7 ? 0.25 : x == 8 ? 0.75 : 0.9;
                edge.at(x, y) = {value * white, value * white, value * white, 1};
            }
        double before = 0.5 * white;
        for (const float stops : {-4.0f, -2.0f, -1.0f, 0.0f}) {
            const ReferenceImage out = developed({.mode = mode, .stops = stops}, edge);
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
    for (const Sharpen& sharpen : {Sharpen{.stops = 0}, Sharpen{.stops = -0.5f}, Sharpen{.stops = -8},
                                   Sharpen{.mode = SharpenMode::Cas, .stops = 0}, Sharpen{.mode = SharpenMode::Cas}})
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
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
        for (const SharpenMode mode : both_modes)
            EXPECT_LE(test::worst_difference(developed({.mode = mode}, picture),
                                             test::reference_of(Sharpen{.mode = mode}, picture)),
                      half_a_code)
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
