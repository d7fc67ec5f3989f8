// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/lens_distortion.hpp>
#include <limits>
#include <vector>

#include "compose/test_stacks/host.hpp"
#include "lens_distortion/lens_distortion_reference.hpp"

namespace darkroom {
namespace {

const std::vector<LensDistortion> settings{{.lens_distortion = 0.4f},
                                           {.lens_distortion = -0.25f},
                                           {.lens_distortion = 0.2f, .quartic = -0.1f, .fill = false},
                                           {.lens_distortion = -0.2f, .quartic = 0.3f, .dispersion = 0.05f},
                                           {.dispersion = -0.1f}};

ReferenceImage developed(const LensDistortion& lens, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(lens); }, picture, {.kernels = kernels});
}

/// Where the pixel at a distance from the centre along the horizontal, in half widths, reads: a picture of coordinates
/// shows it.
double read_from(const LensDistortion& lens, double at) {
    constexpr std::uint32_t width = 801, height = 401;
    ReferenceImage picture(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) picture.at(x, y) = {0, (x + 0.5) / width, 0, 1};
    const ReferenceImage out = test::reference_of(lens, picture);
    return out.at(static_cast<std::uint32_t>((0.5 + 0.5 * at) * width), height / 2).g * 2 - 1;
}

TEST(EffectLensDistortion, IsThePublishedPolynomial) {
    // Along the horizontal r = 1 is half a diagonal: 0.8944 of it is the border. Without filling, the middle stays.
    const double border = 801 / std::hypot(801.0, 401.0);
    const LensDistortion lens{.lens_distortion = 0.3f, .quartic = -0.1f, .fill = false};
    for (const double at : {0.0, 0.25, 0.5, 0.75}) {
        const double x = (std::floor((0.5 + 0.5 * at) * 801) + 0.5) / 801 * 2 - 1, r = x * border;
        EXPECT_NEAR(read_from(lens, at), x * (1 + 0.3 * r * r - 0.1 * r * r * r * r), 1e-6) << at;
    }
}

TEST(EffectLensDistortion, ABarrelShrinksTheBorderAndAPincushionTheMiddle) {
    const auto magnification = [](const LensDistortion& lens, double at) {
        return 0.1 / (read_from(lens, at + 0.05) - read_from(lens, at - 0.05));
    };
    const LensDistortion barrel{.lens_distortion = 0.4f}, pincushion{.lens_distortion = -0.2f};
    EXPECT_GT(magnification(barrel, 0), 1.2 * magnification(barrel, 0.9));
    EXPECT_LT(1.2 * magnification(pincushion, 0), magnification(pincushion, 0.9));
}

TEST(EffectLensDistortion, FillingShowsNothingFromOutsideAndWastesNothing) {
    for (const VkExtent2D extent : {VkExtent2D{160, 90}, {90, 160}, {64, 64}, {1, 1}, {7, 1}})
        for (LensDistortion lens : settings) {
            lens.fill = true;
            const LensDistortionWay way = lens_distortion_way(lens, extent);
            EXPECT_NEAR(double{way.scale}, lens_distortion_reference_scale(lens, extent.width, extent.height), 1e-5);
            // The values of a picture of ones are the part that was inside.
            const ReferenceImage out =
                test::reference_of(lens, test::uniform(extent.width, extent.height, {1, 1, 1, 1}));
            for (const Rgba& color : out.pixels) EXPECT_GE(std::min({color.r, color.g, color.b, color.a}), 1 - 1e-9);
        }
    // Without, a barrel's corners are black.
    const ReferenceImage open = test::reference_of(LensDistortion{.lens_distortion = 0.4f, .fill = false},
                                                   test::uniform(160, 90, {1, 1, 1, 1}));
    EXPECT_EQ(open.at(0, 0).g, 0.0);
    EXPECT_EQ(open.at(80, 45).g, 1.0);
}

TEST(EffectLensDistortion, DispersionPartsRedAndBlueAtTheBorderAlone) {
    ReferenceImage picture = test::uniform(401, 201, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < 201; ++y)
        for (const std::uint32_t x : {20u, 200u}) picture.at(x, y) = {1, 1, 1, 1};
    const ReferenceImage out = developed({.dispersion = 0.05f, .fill = false}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    const auto centroid = [&](std::uint32_t first, std::uint32_t last, double Rgba::*channel) {
        double sum = 0, moment = 0;
        for (std::uint32_t x = first; x < last; ++x) {
            sum += out.at(x, 100).*channel;
            moment += x * (out.at(x, 100).*channel);
        }
        return moment / sum;
    };
    // x = -180 from the centre is r = 0.803: red is read 1.0322 times as far out, so it is seen about 5.3 pixels
    // nearer.
    EXPECT_NEAR(centroid(0, 60, &Rgba::r) - centroid(0, 60, &Rgba::g), 5.3, 0.5);
    EXPECT_NEAR(centroid(0, 60, &Rgba::g) - centroid(0, 60, &Rgba::b), 6.1, 0.5);
    EXPECT_NEAR(centroid(180, 220, &Rgba::r), centroid(180, 220, &Rgba::b), 1e-3);
}

TEST(EffectLensDistortion, ZeroIsOff) {
    const LensDistortion off, filled{.fill = false}, red{.dispersion = 0.01f}, corner{.quartic = 0.01f};
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_TRUE(effect_info(off).is_identity(&filled));
    EXPECT_FALSE(effect_info(off).is_identity(&red));
    EXPECT_FALSE(effect_info(off).is_identity(&corner));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 20, 2));
    EXPECT_EQ(test::worst_difference(developed(off, picture), picture), 0.0);
}

TEST(EffectLensDistortion, WhatFoldsIsRefused) {
    const auto conflict = [](const LensDistortion& lens) { return effect_info(lens).conflict(&lens); };
    for (const LensDistortion& lens : settings) EXPECT_EQ(conflict(lens), "") << lens.lens_distortion;
    EXPECT_EQ(conflict({.lens_distortion = -0.3f, .quartic = -0.1f}),
              "quartic = -0.1: folds the picture together with lens_distortion = -0.3 and dispersion = 0");
    EXPECT_NE(conflict({.lens_distortion = -0.3f, .dispersion = 0.05f}), "");
}

TEST(EffectLensDistortion, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const LensDistortion& lens : settings) {
        SCOPED_TRACE(lens.lens_distortion);
        const ReferenceImage expected = test::reference_of(lens, picture);
        const ReferenceImage filtered = test::reference_of(lens, test::filter_loss(picture));
        // Where a tap falls between two pixels depends on uv in single precision: 1e-4 of a step between neighbours.
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(test::worst_difference(developed(lens, picture, stage), expected, filtered), 1e-4);
    }
}

LensDistortion in_vertices(LensDistortion lens, float columns, float rows) {
    lens.evaluation = LensDistortionEvaluation::Vertex;
    lens.grid = {columns, rows};
    return lens;
}

TEST(EffectLensDistortion, GpuVerticesMatchTheReferenceAndAgreeAsTheGridGrows) {
    ReferenceImage picture(160, 90);
    for (std::uint32_t y = 0; y < 90; ++y)
        for (std::uint32_t x = 0; x < 160; ++x)
            picture.at(x, y) = {0.5 + 0.4 * std::sin(x * 0.2), 0.5 + 0.4 * std::cos(y * 0.15), 0.5 + 0.003 * x, 1};
    picture = test::round_to_float(picture);
    for (const LensDistortion& lens : settings) {
        SCOPED_TRACE(lens.lens_distortion);
        const ReferenceImage exact = developed(lens, picture);
        double before = 1;
        for (const float cells : {2.0f, 4.0f, 8.0f, 64.0f}) {
            const LensDistortion vertices = in_vertices(lens, cells, cells);
            // Half precision keeps a shift of 16 pixels to 2^-7 of one, and a pixel changes a channel by 0.08 at most;
            // where the border turns black, within a pixel, that is all of it.
            const double slope = lens.fill ? 0.08 : 1;
            // A filtered place is as wrong as a filtered grid of up to 16 pixels, and the picture's own fetch.
            const double tolerance = (lens.fill ? 1e-3 : 1e-2) + 2 * gpu::test::filter_step() * (16 + 1) * slope;
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
                EXPECT_LE(
                    test::worst_difference(developed(vertices, picture, stage), test::reference_of(vertices, picture)),
                    tolerance)
                    << cells;
            const double error = test::worst_difference(developed(vertices, picture), exact);
            EXPECT_LT(error, before) << cells;
            before = error;
        }
        // Green's shift and the other channels' beyond it may each be cut off by 2^-6 of a pixel.
        EXPECT_LE(before, lens.fill ? 2 * 0x1p-6 * 0.08 : 2e-2) << "an interpolated grid of 64 x 64";
    }
}

TEST(EffectLensDistortion, GpuAGridFillsTheFrameAsWell) {
    const ReferenceImage ones = test::uniform(97, 61, {1, 1, 1, 1});
    for (LensDistortion lens : settings) {
        lens.fill = true;
        // Between vertices that read inside, all is inside.
        for (const Rgba& color : developed(in_vertices(lens, 3, 5), ones).pixels)
            EXPECT_GE(std::min({color.r, color.g, color.b, color.a}), 1 - 1e-6);
    }
}

TEST(EffectLensDistortion, GpuAGridComesWithTheNextCompile) {
    const ReferenceImage picture = test::round_to_float(test::random_display(40, 24, 5));
    const LensDistortion lens{.lens_distortion = 0.3f};
    test::Host host(picture);
    Composer composer(host.device);
    const Handle entry = composer.add(lens);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);
    test::must(composer.set(entry, in_vertices(lens, 1, 1)));
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0.0);
    test::must(composer.compile(host.compile_desc()));
    EXPECT_GT(test::worst_difference(host.run(composer), before), 0.05);
}

TEST(EffectLensDistortion, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        for (const LensDistortion& lens : settings)
            EXPECT_LE(test::worst_difference(developed(lens, picture), test::reference_of(lens, picture),
                                             test::reference_of(lens, test::filter_loss(picture))),
                      1e-4)
                << width << "x" << height << " " << lens.lens_distortion;
    }
}

}  // namespace
}  // namespace darkroom
