// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <darkroom/effects/halation.hpp>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "halation/halation_reference.hpp"
#include "shared/test_lamp.hpp"
#include "shared/test_no_numbers.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const Halation& halation, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(halation); }, picture, {.kernels = kernels});
}
ReferenceImage reference(const Halation& halation, const ReferenceImage& picture) {
    return halation_reference(&halation, {.picture = &picture, .source = &picture});
}

/// A light of 4x4 pixels in the middle of 256x256, whose bright light has as many texels.
ReferenceImage lamp(double light) {
    ReferenceImage picture(256, 256, {0, 0, 0, 1});
    for (std::uint32_t y = 128; y < 132; ++y)
        for (std::uint32_t x = 128; x < 132; ++x) picture.at(x, y) = {light, light, light, 1};
    return picture;
}
double sum_of(const ReferenceImage& picture, double Rgba::*channel) {
    double sum = 0;
    for (const Rgba& color : picture.pixels) sum += color.*channel;
    return sum;
}

TEST(EffectHalation, ThePictureKeepsItsLight) {
    const ReferenceImage picture = lamp(101), out = reference({.intensity = 0.8f, .radius = 16}, picture);
    for (const auto channel : {&Rgba::r, &Rgba::g, &Rgba::b})
        EXPECT_NEAR(sum_of(out, channel) / sum_of(picture, channel), 1, 1e-4);
    EXPECT_LT(out.at(130, 130).r, 50);
    EXPECT_GT(out.at(140, 130).r, 0.01);
}

TEST(EffectHalation, OrGainsWhatComesBack) {
    const Halation halation{.intensity = 0.5f, .radius = 16, .tint = {1, 0.5f, 0}, .conserves_energy = false};
    const ReferenceImage picture = lamp(101), out = reference(halation, picture);
    EXPECT_NEAR((sum_of(out, &Rgba::r) - sum_of(picture, &Rgba::r)) / (16 * 100), 0.5, 1e-4);
    EXPECT_NEAR((sum_of(out, &Rgba::g) - sum_of(picture, &Rgba::g)) / (16 * 100), 0.25, 1e-4);
    EXPECT_EQ(sum_of(out, &Rgba::b), sum_of(picture, &Rgba::b));
}

// The radius' variance, less that of the mean over a texel, which a texel of the lamp is already, and that of the
// lamp's texels; and three times the radius.
TEST(EffectHalation, TheRadiusIsTheDeviation) {
    for (const float radius : {24.0f, 32.0f})
        for (const bool is_far : {false, true}) {
            const Halation halation{
                .intensity = 1, .radius = radius, .spread = is_far ? 1.0f : 0.0f, .conserves_energy = false};
            const ReferenceImage picture = lamp(101), out = reference(halation, picture);
            double all = 0, across = 0, down = 0;
            for (std::uint32_t y = 0; y < 256; ++y)
                for (std::uint32_t x = 0; x < 256; ++x) {
                    const double added = out.at(x, y).r - picture.at(x, y).r;
                    all += added;
                    across += added * (x - 129.5) * (x - 129.5);
                    down += added * (y - 129.5) * (y - 129.5);
                }
            const double deviation = (is_far ? 3 : 1) * double{radius} * 256 / 1080;
            const double expected = deviation * deviation - 1.0 / 12 + (16 - 1) / 12.0;
            EXPECT_NEAR(across / all / expected, 1, 0.04) << radius << ", " << is_far;
            EXPECT_NEAR(down / all / expected, 1, 0.04) << radius << ", " << is_far;
        }
}

// As far as a standard deviation of the far glow from a lamp, in all directions: it may not be a square.
TEST(EffectHalation, GlowsAreRoundInPicturesOfFewLines) {
    for (const std::uint32_t lines : {269u, 378u}) {
        ReferenceImage picture(lines, lines, {0, 0, 0, 1});
        const double x = 0.5 * lines + 1.7, y = 0.5 * lines - 2.3;
        const auto distance = [&](std::uint32_t i, std::uint32_t j) { return std::hypot(i + 0.5 - x, j + 0.5 - y); };
        for (std::uint32_t j = 0; j < lines; ++j)
            for (std::uint32_t i = 0; i < lines; ++i)
                if (distance(i, j) < lines / 100.0) picture.at(i, j) = {90, 90, 90, 1};
        const ReferenceImage out = reference({.intensity = 1}, picture);
        const double far = 3 * 10.0 * lines / 1080;
        double least = 1e9, most = 0;
        for (std::uint32_t j = 0; j < lines; ++j)
            for (std::uint32_t i = 0; i < lines; ++i)
                if (std::abs(distance(i, j) - far) < 0.5) {
                    least = std::min(least, out.at(i, j).r);
                    most = std::max(most, out.at(i, j).r);
                }
        EXPECT_LT(most / least, 2) << lines;
    }
}

TEST(EffectHalation, GpuLeavesFlatFieldsAndDarkPicturesAlone) {
    const ReferenceImage flat = test::uniform(64, 48, {4, 3, 2, 1}), out = developed({.intensity = 1}, flat);
    EXPECT_LE(test::worst_difference(out, flat), 4 * 0x1p-8);
    const ReferenceImage dark = test::round_to_float(test::random_display(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 1, .threshold = 1}, dark), dark), 0);
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0, .threshold = 0}, dark), dark), 0);
}

/// Light up to 3, which is above the threshold nearly everywhere.
ReferenceImage lights(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::random_display(width, height, 63);
    for (Rgba& color : picture.pixels) color = {3 * color.r, 3 * color.g, 3 * color.b, color.a};
    return test::round_to_float(picture);
}

TEST(EffectHalation, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{128u, 72u}, {131u, 67u}, {1u, 1u}, {9u, 2u}})
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            for (const Halation& halation : {Halation{.intensity = 1, .radius = 32, .tint = {1, 1, 1}},
                                             Halation{.threshold = 0.3f, .spread = 0.7f, .conserves_energy = false}}) {
                const ReferenceImage picture = lights(width, height), expected = reference(halation, picture);
                const ReferenceImage out = developed(halation, picture, kernels);
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                // Six writes in half precision of light up to 3, which may be cut off, and places of taps.
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    EXPECT_NEAR(out.pixels[i].r, expected.pixels[i].r,
                                double{halation.intensity} * 3 * (6 * 0x1p-10 + 0x1p-14 + 2 * gpu::test::filter_step()))
                        << width << "x" << height << ", " << i;
                    EXPECT_EQ(out.pixels[i].a, picture.pixels[i].a);
                }
            }
}

TEST(EffectHalation, GpuNanAndInfinityStayContained) {
    test::expect_contained(developed({}, test::grey_with_no_numbers()));
}

TEST(EffectHalation, GpuLampsCountAlikeWhereverTheyLie) {
    test::expect_lamps_count_alike(
        [](Composer& composer) {
            composer.add(Halation{.intensity = 1, .threshold = 0, .tint = {1, 1, 1}, .conserves_energy = false});
        },
        {1, 1, 1});
}

}  // namespace
}  // namespace darkroom
