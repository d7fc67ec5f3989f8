// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/lens_dirt.hpp>
#include <vector>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "lens_dirt/lens_dirt_reference.hpp"
#include "shared/test_lamp.hpp"
#include "shared/test_no_numbers.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const LensDirt& dirt, const ReferenceImage& picture, KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(dirt); }, picture, {.kernels = kernels});
}
/// With dirt of one colour.
ReferenceImage reference_on(const LensDirt& dirt, const ReferenceImage& picture, float r, float g, float b) {
    LensDirt named = dirt;
    named.dirt.id = 7;
    const Resources resources{
        {7, std::make_shared<ResourceData>(ResourceImage{.width = 1, .height = 1, .rgba = {r, g, b, 1}})}};
    return lens_dirt_reference(&named, {.picture = &picture, .source = &picture, .resources = &resources});
}
/// A light of 16x16 pixels, which are a texel of the blurred picture, in the middle of 512x512.
ReferenceImage lamp(double light) {
    ReferenceImage picture(512, 512, {0, 0, 0, 1});
    for (std::uint32_t y = 256; y < 272; ++y)
        for (std::uint32_t x = 256; x < 272; ++x) picture.at(x, y) = {light, light, light, 1};
    return picture;
}
double sum_of(const ReferenceImage& picture, double Rgba::*channel) {
    double sum = 0;
    for (const Rgba& color : picture.pixels) sum += color.*channel;
    return sum;
}

TEST(EffectLensDirt, DirtThatIsWhiteAddsTheLightAround) {
    const LensDirt dirt{.intensity = 0.5f, .radius = 80};
    const ReferenceImage picture = lamp(101), out = reference_on(dirt, picture, 1, 0.4f, 0);
    EXPECT_NEAR((sum_of(out, &Rgba::r) - sum_of(picture, &Rgba::r)) / (256 * 100), 0.5, 1e-3);
    EXPECT_NEAR((sum_of(out, &Rgba::g) - sum_of(picture, &Rgba::g)) / (256 * 100), 0.2, 1e-3);
    EXPECT_EQ(sum_of(out, &Rgba::b), sum_of(picture, &Rgba::b));
    double all = 0, across = 0;
    for (std::uint32_t y = 0; y < 512; ++y)
        for (std::uint32_t x = 0; x < 512; ++x) {
            const double added = out.at(x, y).r - picture.at(x, y).r;
            all += added;
            across += added * (x - 263.5) * (x - 263.5);
        }
    // The lamp is as wide as the mean over a texel, which the variance counts.
    const double deviation = 80.0 * 512 / 1080;
    EXPECT_NEAR(across / all / (deviation * deviation - 256.0 / 12), 1, 0.04);
}

// Dust whose edge lay within a texel was of squares.
TEST(EffectLensDirt, DustHasNoEdgesOfTexels) {
    const LensDirtTable table = lens_dirt_table(nullptr);
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        return static_cast<int>(table.rgba[(std::size_t{y} * table.width + x) * 4]);
    };
    for (std::uint32_t y = 0; y + 1 < table.height; ++y)
        for (std::uint32_t x = 0; x + 1 < table.width; ++x)
            for (const int beside : {at(x + 1, y), at(x, y + 1)})
                EXPECT_TRUE(std::min(at(x, y), beside) > 0 || std::max(at(x, y), beside) < 120) << x << ", " << y;
}

TEST(EffectLensDirt, EveryTexelIsItsBrightestDisc) {
    const LensDirtTable table = lens_dirt_table(nullptr);
    ASSERT_EQ(table.rgba.size(), std::size_t{lens_dirt_width} * lens_dirt_height * 4);
    double covered = 0;
    for (std::uint32_t y = 0; y < lens_dirt_height; y += 3)
        for (std::uint32_t x = 0; x < lens_dirt_width; x += 3) {
            double expected = 0;
            for (const LensDirtDisc& disc : lens_dirt_discs()) {
                const double distance =
                    std::hypot((x + 0.5) / lens_dirt_height - disc.x, (y + 0.5) / lens_dirt_height - disc.y);
                if (distance < disc.radius) expected = std::max(expected, lens_dirt_profile(disc, distance));
            }
            EXPECT_NEAR(table.rgba[(std::size_t{y} * lens_dirt_width + x) * 4 + 1] / 255.0, expected, 0.5 / 255 + 1e-9);
            covered += expected > 0 ? 9.0 / (lens_dirt_width * lens_dirt_height) : 0;
        }
    EXPECT_GT(covered, 0.05);
    EXPECT_LT(covered, 0.6);
}

TEST(EffectLensDirt, ADiscIsBrighterTowardItsRimAndEndsThere) {
    const LensDirtDisc disc{.radius = 0.05, .brightness = 0.5};
    EXPECT_DOUBLE_EQ(lens_dirt_profile(disc, 0), 0.3);
    EXPECT_GT(lens_dirt_profile(disc, 0.042), lens_dirt_profile(disc, 0.02));
    EXPECT_EQ(lens_dirt_profile(disc, 0.05), 0);
    EXPECT_EQ(lens_dirt_profile(disc, 0.08), 0);
}

/// Light up to 3, which is above the threshold nearly everywhere.
ReferenceImage lights(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::random_display(width, height, 64);
    for (Rgba& color : picture.pixels) color = {3 * color.r, 3 * color.g, 3 * color.b, color.a};
    return test::round_to_float(picture);
}

TEST(EffectLensDirt, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{128u, 72u}, {131u, 67u}, {1u, 1u}, {9u, 2u}})
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            for (const LensDirt& dirt : {LensDirt{.intensity = 2}, LensDirt{.threshold = 0.3f, .radius = 128}}) {
                const ReferenceImage picture = lights(width, height), expected = test::reference_of(dirt, picture);
                const ReferenceImage out = developed(dirt, picture, kernels);
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                // Four writes in half precision, which may be cut off, of light up to 3, and places of taps; some
                // drivers round a filtered fetch of 8 bits to 8 bits.
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    const double added = expected.pixels[i].r - picture.pixels[i].r;
                    EXPECT_NEAR(out.pixels[i].r, expected.pixels[i].r,
                                added * 4 * 0x1p-10 + 1e-5 +
                                    double{dirt.intensity} * 3 * (1.0 / 255 + 2 * gpu::test::filter_step()))
                        << width << "x" << height << ", " << i;
                    EXPECT_EQ(out.pixels[i].a, picture.pixels[i].a);
                }
            }
}

TEST(EffectLensDirt, GpuReadsAPictureOfDirt) {
    const ReferenceImage picture = lights(64, 48);
    const auto with = [&](float value) {
        return test::develop(
            [&](Composer& composer) {
                const auto named =
                    composer.define(ResourceImage{.width = 1, .height = 1, .rgba = {value, 0, value, 1}});
                ASSERT_TRUE(named);
                composer.add(LensDirt{.intensity = 1, .dirt = *named});
            },
            picture);
    };
    const ReferenceImage full = with(1), half = with(0.6f), none = with(0);
    ASSERT_EQ(full.pixels.size(), picture.pixels.size());
    EXPECT_EQ(test::worst_difference(none, picture), 0);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        EXPECT_NEAR(half.pixels[i].r - picture.pixels[i].r, 0.6 * (full.pixels[i].r - picture.pixels[i].r), 1e-4);
        EXPECT_EQ(full.pixels[i].g, picture.pixels[i].g);
    }
}

TEST(EffectLensDirt, GpuLeavesDarkPicturesAlone) {
    const ReferenceImage picture = test::round_to_float(test::random_display(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 4, .threshold = 1}, picture), picture), 0);
    const ReferenceImage bright = lights(64, 48);
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, bright), bright), 0);
}

TEST(EffectLensDirt, GpuNanAndInfinityStayContained) {
    test::expect_contained(developed({}, test::grey_with_no_numbers()));
}

TEST(EffectLensDirt, GpuLampsCountAlikeWhereverTheyLie) {
    test::expect_lamps_count_alike(
        [](Composer& composer) {
            const auto white = composer.define(ResourceImage{.width = 1, .height = 1, .rgba = {1, 1, 1, 1}});
            ASSERT_TRUE(white);
            composer.add(LensDirt{.intensity = 1, .threshold = 0, .radius = 20, .dirt = *white});
        },
        {1, 1, 1});
}

}  // namespace
}  // namespace darkroom
