// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <darkroom/effects/bloom.hpp>
#include <limits>
#include <utility>

#include "bloom/bloom_reference.hpp"
#include "bloom/bloom_test_pictures.hpp"
#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "image/compare/flip.hpp"
#include "shared/test_lamp.hpp"

namespace darkroom {
namespace {

using test::everything_glows;
using test::impulse;
using test::published;
using test::red_sum;

/// What a write may lose: of the value, and of values below 2^-14. A packed channel is rounded, a half may be cut off.
struct Write {
    double relative = 0, absolute = 0;
};
constexpr Write half{0x1p-10, 0x1p-22}, six_bits{0x1p-7, 0x1p-20}, five_bits{0x1p-6, 0x1p-19};

/// The largest excess over what rounding can explain. The longest way through the pyramid has 2 * levels - 1 writes.
/// The final sum is float: 1e-6 of the value, and of the picture under it.
double worst_excess(const Bloom& bloom, const ReferenceImage& picture, const ReferenceImage& gpu,
                    bool is_packed = false) {
    const ReferenceImage expected = test::reference_of(bloom, picture);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    const double writes = 2.0 * bloom.levels - 1;
    const BloomWeights weights = bloom_weights(bloom, {picture.width, picture.height});
    const double first = weights.count == 0 ? 1 : weights.weights[0] / bloom_stored_weight(weights);
    // Every pass may lose what a filtered fetch does of all light, and the glow hands that on as it does light.
    Bloom all = bloom;
    all.threshold = all.soft_threshold = 0;
    all.firefly_filter = false;
    const ReferenceImage filtered = test::reference_of(all, test::filter_loss(picture));
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &base = picture.pixels[i];
        const Rgba& lost = filtered.pixels[i];
        const auto check = [&](double w, double g, double b, const Write& write, double loss) {
            const double kept = bloom.mode == BloomMode::Additive ? b : b * (1.0 - bloom.intensity);
            const double allowed = std::abs(w - kept) * writes * write.relative +
                                   bloom.intensity * first * writes * write.absolute +
                                   (std::abs(w) + std::abs(b)) * 2e-6 + writes * loss;
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, base.r, is_packed ? six_bits : half, lost.r);
        check(want.g, got.g, base.g, is_packed ? six_bits : half, lost.g);
        check(want.b, got.b, base.b, is_packed ? five_bits : half, lost.b);
        if (got.a != static_cast<double>(static_cast<float>(base.a))) return 1e9;
    }
    return worst;
}

ReferenceImage developed(const Bloom& bloom, const ReferenceImage& picture, KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(bloom); }, picture, {.kernels = kernels});
}

TEST(BloomGpu, MatchesTheReference) {
    struct Case {
        std::uint32_t width, height;
        Bloom bloom;
    };
    const Bloom conserving{.intensity = 0.6f, .mode = BloomMode::EnergyConserving};
    for (const Case& c : {Case{256, 256, {.intensity = 0.5f}}, Case{255, 67, {.intensity = 0.5f}},
                          Case{301, 257, {.intensity = 2, .firefly_filter = false}},
                          Case{256, 300, everything_glows(2)}, Case{64, 64, everything_glows(1)},
                          Case{131, 97, conserving}, Case{16, 16, {}}, Case{15, 40, {}}, Case{15, 40, conserving}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(c.width, c.height, 11));
        for (const Bloom& bloom : {c.bloom, published(c.bloom)})
            EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture)), 1.0) << c.width << "x" << c.height;
    }
}

TEST(BloomGpu, BothStagesMatchTheReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(96, 70, 3));
    const Bloom bloom = published({.intensity = 1});
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
        EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture, kernels)), 1.0);
}

/// Lamps of several colours before a dim wall that grows brighter downward: smooth glows are where steps would show.
ReferenceImage lamps() {
    ReferenceImage out(256, 256);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double wall = 0.02 + 0.1 * y / out.height;
            out.at(x, y) = {wall, wall * 0.9, wall * 0.8, 1};
            if (std::hypot(x - 50.0, y - 60.0) < 7) out.at(x, y) = {80, 70, 50, 1};
            if (std::hypot(x - 190.0, y - 80.0) < 7) out.at(x, y) = {40, 3, 2, 1};
            if (std::hypot(x - 110.0, y - 190.0) < 7) out.at(x, y) = {8, 10, 30, 1};
        }
    return test::round_to_float(out);
}

double flip_of(const ReferenceImage& a, const ReferenceImage& b) {
    const auto picture = [](const ReferenceImage& image) {
        Picture out(image.width, image.height);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const Rgba& color = image.pixels[i];
            const std::array channels{color.r, color.g, color.b, 1.0};
            for (std::size_t c = 0; c < 4; ++c) out.pixels[4 * i + c] = static_cast<float>(channels[c]);
        }
        return out;
    };
    const auto errors = flip(picture(a), picture(b), {.encoding = PictureEncoding::SceneLinear});
    return errors ? errors->mean : 1e9;
}

/// As the planner has it for a GPU: in compute kernels, with a packed pyramid.
ReferenceImage developed_packed(const Bloom& bloom, const ReferenceImage& picture) {
    bool& is_software = gpu::test::context().traits.is_software;
    const bool before = std::exchange(is_software, false);
    ReferenceImage out = developed(bloom, picture);
    is_software = before;
    return out;
}

TEST(BloomGpu, ThePackedPyramidMatchesTheReference) {
    if (!gpu::test::context().supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device cannot store packed floats";
    const ReferenceImage picture = test::round_to_float(test::random_hdr(301, 257, 3));
    for (const Bloom& bloom : {published({.intensity = 1}), Bloom{.intensity = 1},
                               published({.intensity = 0.6f, .mode = BloomMode::EnergyConserving})})
        EXPECT_LE(worst_excess(bloom, picture, developed_packed(bloom, picture), true), 1.0);
    const ReferenceImage flat = test::uniform(256, 256, {65504, 65504, 65504, 1});
    for (const Rgba& color : developed_packed(everything_glows(5), flat).pixels)
        EXPECT_NEAR(color.b, 2 * 65504.0, 65504.0 * 9 * 0x1p-6);
}

TEST(BloomGpu, ThePackedPyramidIsHardlySeen) {
    if (!gpu::test::context().supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device cannot store packed floats";
    const ReferenceImage picture = lamps();
    const Bloom bloom = published({.intensity = 0.3f});
    const ReferenceImage expected = test::reference_of(bloom, picture);
    const double packed = flip_of(expected, developed_packed(bloom, picture));
    EXPECT_LT(packed, 0.01);
    // Fragment kernels blend, and never pack.
    EXPECT_LT(flip_of(expected, developed(bloom, picture, KernelStage::Raster)), packed) << "half floats";
}

TEST(BloomGpu, LeanAndCompleteKernelsMatchTheReference) {
    struct Case {
        std::uint32_t width, height;
        Bloom bloom;
    };
    const Bloom conserving = published({.intensity = 1, .mode = BloomMode::EnergyConserving, .scatter = 1});
    for (const Case& c : {Case{256, 512, published({.intensity = 1})}, Case{256, 256, everything_glows(5)},
                          Case{64, 160, conserving}, Case{32, 34, everything_glows(2)},
                          Case{32, 33, everything_glows(2)}, Case{33, 32, published({.intensity = 1})}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(c.width, c.height, 7));
        for (const bool lean : {true, false})
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(c.bloom); }, picture,
                                                         {.kernels = kernels, .wait_for_lean_kernels = lean});
                EXPECT_LE(worst_excess(c.bloom, picture, out), 1.0) << c.width << "x" << c.height << " lean " << lean;
            }
    }
}

TEST(BloomGpu, LightBelowZeroTakesFromItsNeighbours) {
    // Means are cleaned, not texels: of 8 and -4 a glow of 2 is left, and of 8 and -12 none.
    for (const std::uint32_t width : {64u, 65u}) {
        ReferenceImage picture = test::uniform(width, 64, {8, 8, 8, 1});
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = y % 2; x < width; x += 2) picture.at(x, y) = {-4, -12, 0, 1};
        const ReferenceImage out = developed(everything_glows(1), picture);
        EXPECT_LE(worst_excess(everything_glows(1), picture, out), 1.0) << width;
        if (width == 65 || out.pixels.empty()) continue;
        EXPECT_NEAR(out.at(33, 32).r - picture.at(33, 32).r, 2.0, 0.01);
        EXPECT_EQ(out.at(33, 32).g - picture.at(33, 32).g, 0.0);
    }
}

// At all places under a tap. What a sampler makes of infinity is its own: NaN where it counts nothing of it, so that it
// glows as the largest number does, as NaN, or in between.
TEST(BloomGpu, WhatIsNoNumberGlowsAsInTheReference) {
    const Bloom bloom = everything_glows(1);
    for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        for (std::uint32_t i = 0; i < 16; ++i) {
            const std::uint32_t bad_x = 30 + i % 4, bad_y = 30 + i / 4;
            ReferenceImage picture = test::uniform(64, 64, {0.5, 2, 8, 1});
            picture.at(bad_x, bad_y).r = picture.at(bad_x, bad_y).g = bad;
            ReferenceImage least = picture;
            least.at(bad_x, bad_y).r = least.at(bad_x, bad_y).g = std::numeric_limits<double>::quiet_NaN();
            const ReferenceImage most = test::reference_of(bloom, picture);
            least = test::reference_of(bloom, least);
            const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(bloom); }, picture,
                                                     {.wait_for_lean_kernels = true});
            ASSERT_EQ(out.pixels.size(), most.pixels.size());
            for (std::uint32_t y = 0; y < 64; ++y)
                for (std::uint32_t x = 0; x < 64; ++x) {
                    if (x == bad_x && y == bad_y) continue;
                    EXPECT_GE(out.at(x, y).r / least.at(x, y).r, 1 - 2e-3) << bad << ": " << x << "," << y;
                    EXPECT_LE(out.at(x, y).r / most.at(x, y).r, 1 + 2e-3) << bad << ": " << x << "," << y;
                    EXPECT_NEAR(out.at(x, y).b / most.at(x, y).b, 1, 2e-3) << bad << ": " << x << "," << y;
                }
        }
}

TEST(BloomGpu, TheConservingModeKeepsTheLightOfALonePixel) {
    const Bloom bloom{.intensity = 1, .firefly_filter = true, .mode = BloomMode::EnergyConserving, .levels = 3};
    // Halves that are cut off at each of five writes.
    EXPECT_NEAR(red_sum(developed(bloom, impulse(256, 256, 128, 120, 500))), 500, 500 * 5 * 0x1p-10);
}

TEST(BloomGpu, IntensityZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, picture), picture), 0.0);
}

TEST(BloomGpu, SymmetricPicturesStaySymmetric) {
    ReferenceImage picture(128, 128);
    for (const std::uint32_t x : {40u, 87u})
        for (const std::uint32_t y : {40u, 87u}) picture.at(x, y) = {300, 30, 3, 1};
    const ReferenceImage out = developed(published({.intensity = 1}), picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    // Sums in another order differ in the last bit before a store cuts off: one half step a write.
    for (std::uint32_t y = 0; y < 128; ++y)
        for (std::uint32_t x = 0; x < 128; ++x) {
            EXPECT_NEAR(out.at(x, y).r, out.at(127 - x, y).r, out.at(x, y).r * 7 * 0x1p-10);
            EXPECT_NEAR(out.at(x, y).r, out.at(x, 127 - y).r, out.at(x, y).r * 7 * 0x1p-10);
        }
}

TEST(BloomGpu, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const std::uint32_t side : {256u, 255u}) {
        ReferenceImage picture = test::round_to_float(test::random_display(side, side, 9)), broken = picture;
        picture.at(100, 100) = {0, 0, 0, 1};
        broken.at(100, 100) = {nan, nan, nan, 1};
        const Bloom bloom = everything_glows(1);
        const ReferenceImage clean = developed(bloom, picture), out = developed(bloom, broken);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                if (x == 100 && y == 100) continue;
                EXPECT_TRUE(std::isfinite(out.at(x, y).r)) << x << "," << y << " of " << side;
                // Three source texels of the filter, and two of the bilinear read of level 0.
                if (std::max(std::abs(int(x) - 100), std::abs(int(y) - 100)) > 6) {
                    EXPECT_EQ(out.at(x, y).r, clean.at(x, y).r);
                }
            }

        const ReferenceImage black = test::uniform(side, side, {0, 0, 0, 1});
        ReferenceImage bright = black;
        bright.at(100, 100) = {infinity, -infinity, 0, 1};
        for (const Bloom& values : {Bloom{}, everything_glows(4)}) {
            const ReferenceImage glow = developed(values, bright);
            ASSERT_EQ(glow.pixels.size(), black.pixels.size());
            for (std::uint32_t y = 0; y < side; ++y)
                for (std::uint32_t x = 0; x < side; ++x)
                    if (x != 100 || y != 100) {
                        EXPECT_TRUE(std::isfinite(glow.at(x, y).r) && glow.at(x, y).g == 0.0) << x << "," << y;
                    }
        }
    }
}

TEST(BloomGpu, HugeFieldsStayFinite) {
    const ReferenceImage flat = test::uniform(256, 256, {65504, 65504, 65504, 1});
    const ReferenceImage out = developed(everything_glows(5), flat);
    ASSERT_EQ(out.pixels.size(), flat.pixels.size());
    for (const Rgba& color : out.pixels) EXPECT_NEAR(color.r, 2 * 65504.0, 65504.0 * 9 * 0x1p-10);
    // With few lines the first level counts for many, and those behind it must not be stored times as much.
    const ReferenceImage low = test::uniform(480, 270, {65504, 65504, 65504, 1});
    for (const Rgba& color : developed({.intensity = 1, .mode = BloomMode::EnergyConserving}, low).pixels)
        EXPECT_NEAR(color.r, 65504, 65504.0 * 9 * 0x1p-10);
}

/// What the firefly filter leaves of a pixel of light in an even picture, in all: boxes of 4x4 pixels, of which one
/// counts 1/2 and lies in the middle of the others, each by 1 / (1 + luminance).
double left_of(double light, double luminance) {
    struct Box {
        int x, y;
        double weight;
    };
    double sum = 0;
    for (int y = -4; y <= 4; y += 2)
        for (int x = -4; x <= 4; x += 2) {
            double mean = 0, weights = 0;
            for (const Box& box : {Box{0, 0, 0.5}, {-1, -1, 0.125}, {1, -1, 0.125}, {-1, 1, 0.125}, {1, 1, 0.125}}) {
                const auto has = [](int first) { return first - 2 <= 0 && first + 2 > 0; };
                const double own = has(x + 1 + box.x) && has(y + 1 + box.y) ? light / 16 : 0;
                const double weight = box.weight / (1 + luminance * own);
                mean += weight * own, weights += weight;
            }
            sum += 4 * mean / weights;
        }
    return sum;
}

TEST(BloomGpu, LampsCountAlikeWhereverTheyLie) {
    // Two levels add all light each.
    Bloom bloom{.intensity = 1, .threshold = 0, .soft_threshold = 0, .firefly_filter = false, .reach = Reach::Pixels};
    bloom.levels = 2;
    test::expect_lamps_count_alike([&](Composer& composer) { composer.add(bloom); }, {2, 2, 2});
    bloom.firefly_filter = true;
    test::expect_lamps_count_alike(
        [&](Composer& composer) { composer.add(bloom); },
        {2 * left_of(100, 0.2126) / 100, 2 * left_of(100, 0.7152) / 100, 2 * left_of(100, 0.0722) / 100});
}

}  // namespace
}  // namespace darkroom
