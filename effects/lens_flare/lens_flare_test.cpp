// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/lens_flare.hpp>
#include <numbers>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "lens_flare/lens_flare_reference.hpp"
#include "shared/test_lamp.hpp"
#include "shared/test_no_numbers.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const LensFlare& flare, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(flare); }, picture, {.kernels = kernels});
}

/// A small picture, as the flare is made of, with a spot of 5x5 texels at a place from the middle, in widths and
/// heights.
ReferenceImage spot_at(double x, double y, std::uint32_t width = 192, std::uint32_t height = 108) {
    ReferenceImage light(width, height, {0, 0, 0, 1});
    const auto column = static_cast<std::int64_t>(std::floor((x + 0.5) * width));
    const auto row = static_cast<std::int64_t>(std::floor((y + 0.5) * height));
    for (std::int64_t dy = -2; dy <= 2; ++dy)
        for (std::int64_t dx = -2; dx <= 2; ++dx)
            light.at(static_cast<std::uint32_t>(column + dx), static_cast<std::uint32_t>(row + dy)) = {1, 1, 1, 1};
    return light;
}
double sum_of(const ReferenceImage& picture, double Rgba::*channel) {
    double sum = 0;
    for (const Rgba& color : picture.pixels) sum += color.*channel;
    return sum;
}
double green_at(const ReferenceImage& picture, double x, double y) {
    return sample_reference(picture, x + 0.5, y + 0.5).g;
}

/// Of a light, as large as its picture.
ReferenceImage parts_of(const LensFlare& flare, const ReferenceImage& light, double aspect) {
    return lens_flare_parts_reference(flare, light, aspect, {light.width, light.height});
}

TEST(EffectLensFlare, GhostsLieWhereTheFormulaSays) {
    const LensFlare flare{.ghosts = 5, .spacing = 0.25f, .halo = 0, .dispersion = 0, .starburst = 0};
    const double x = 0.28, y = -0.19;
    const ReferenceImage parts = parts_of(flare, spot_at(x, y), 16.0 / 9);
    const double scales[] = {-1, 1.25, -1.5, 1.75, -2};
    for (std::int32_t ghost = 0; ghost < 5; ++ghost) {
        const double scale = scales[ghost];
        EXPECT_DOUBLE_EQ(lens_flare_scale(flare, ghost), scale);
        EXPECT_NEAR(green_at(parts, x / scale, y / scale), lens_flare_color(flare, ghost)[1],
                    0.3 * lens_flare_color(flare, ghost)[1])
            << ghost;
        EXPECT_EQ(green_at(parts, x / scale, y / scale + 0.06), 0) << ghost << ": beside the line";
    }
    // Nothing but the ghosts: each has the light's energy, smaller by its area.
    double energy = 0;
    for (std::int32_t ghost = 0; ghost < 5; ++ghost)
        energy += 25 * lens_flare_color(flare, ghost)[1] / (scales[ghost] * scales[ghost]);
    EXPECT_NEAR(sum_of(parts, &Rgba::g) / energy, 1, 0.05);
}

TEST(EffectLensFlare, TheFirstGhostIsTheLightTurned) {
    const LensFlare flare{.ghosts = 1, .halo = 0, .dispersion = 0, .starburst = 0};
    const ReferenceImage light = spot_at(0.2, 0.1), parts = parts_of(flare, light, 16.0 / 9);
    for (std::uint32_t y = 0; y < light.height; ++y)
        for (std::uint32_t x = 0; x < light.width; ++x)
            EXPECT_NEAR(parts.at(x, y).r, light.at(light.width - 1 - x, light.height - 1 - y).r, 1e-9);
}

// The mean square of the distances from the middle of a regular polygon is R^2 (2 + cos(2 pi / n)) / 6.
TEST(EffectLensFlare, AGhostOfALampIsTheAperture) {
    for (const std::int32_t blades : {3, 6, 16}) {
        const LensFlare flare{
            .intensity = 1, .ghosts = 1, .halo = 0, .dispersion = 0, .blades = blades, .starburst = 0};
        ReferenceImage picture(640, 1080, {0, 0, 0, 1});
        for (std::uint32_t y = 504; y < 512; ++y)
            for (std::uint32_t x = 304; x < 312; ++x) picture.at(x, y) = {1001, 1001, 1001, 1};
        const ReferenceImage out = test::reference_of(flare, picture);
        double all = 0, square = 0;
        for (std::uint32_t y = 0; y < out.height; ++y)
            for (std::uint32_t x = 0; x < out.width; ++x) {
                const double added = out.at(x, y).g - picture.at(x, y).g;
                all += added, square += added * (std::pow(x + 0.5 - 332, 2) + std::pow(y + 0.5 - 572, 2));
            }
        const double radius = 0.06 * 1080;
        // The lamp's own size and the taps between texels of 8 and of 4 pixels add some 60 to it.
        EXPECT_NEAR(square / all - 60, radius * radius * (2 + std::cos(2 * std::numbers::pi / blades)) / 6,
                    0.03 * radius * radius)
            << blades;
        EXPECT_NEAR(all / (64 * 1000), 1, 0.02) << blades;
    }
}

TEST(EffectLensFlare, ColorsOfGhostsAddUpToWhite) {
    for (const std::int32_t count : {1, 2, 3, 7, 16}) {
        const LensFlare flare{.ghosts = count};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double sum = 0;
            for (std::int32_t ghost = 0; ghost < count; ++ghost) sum += lens_flare_color(flare, ghost)[channel];
            EXPECT_NEAR(sum, count, 1e-9);
        }
    }
}

/// The distance from the middle, in heights, of the flare's middle in a direction.
double middle_at(const ReferenceImage& parts, double angle_rad, double aspect, double Rgba::*channel) {
    double sum = 0, weighed = 0;
    for (double distance = 0.1; distance < 0.5; distance += 0.001) {
        const double value = sample_reference(parts, distance * std::cos(angle_rad) / aspect + 0.5,
                                              distance * std::sin(angle_rad) + 0.5).*
                             channel;
        sum += value;
        weighed += value * distance;
    }
    return weighed / sum;
}

TEST(EffectLensFlare, TheHaloIsARoundRing) {
    // The middle is a texel's.
    const ReferenceImage light = spot_at(0, 0, 193, 109);
    const double aspect = 193.0 / 109;
    const LensFlare flare{.ghosts = 0, .halo = 1, .halo_radius = 0.35f, .dispersion = 0, .starburst = 0};
    const ReferenceImage parts = parts_of(flare, light, aspect);
    for (int i = 0; i < 24; ++i)
        EXPECT_NEAR(middle_at(parts, i * std::numbers::pi / 12, aspect, &Rgba::g), 0.35, 0.5 / 109) << i;
    LensFlare apart = flare;
    apart.dispersion = 0.2f;
    const ReferenceImage colored = parts_of(apart, light, aspect);
    EXPECT_NEAR(middle_at(colored, 0.3, aspect, &Rgba::r), 0.35 * 1.2, 0.5 / 109);
    EXPECT_NEAR(middle_at(colored, 0.3, aspect, &Rgba::b), 0.35 * 0.8, 0.5 / 109);
}

TEST(EffectLensFlare, EvenBladesHaveAsManyRaysAndOddOnesTwice) {
    const ReferenceImage light = test::uniform(193, 109, {1, 1, 1, 1});
    for (const auto& [blades, rays] : {std::pair{3, 6}, {4, 4}, {5, 10}, {6, 6}, {9, 18}}) {
        const LensFlare flare{.ghosts = 1, .halo = 0, .dispersion = 0, .blades = blades, .starburst = 1};
        const ReferenceImage parts = parts_of(flare, light, 193.0 / 109);
        constexpr int steps = 720;
        const auto at = [&](int i) {
            const double angle = 2 * std::numbers::pi * i / steps;
            return green_at(parts, 0.3 * std::cos(angle) * 109 / 193, 0.3 * std::sin(angle));
        };
        int found = 0;
        double mean = 0;
        for (int i = 0; i < steps; ++i) {
            found += at(i) > 1.8 && at((i + steps - 1) % steps) <= 1.8 ? 1 : 0;
            mean += at(i) / steps;
        }
        EXPECT_EQ(found, rays) << blades;
        EXPECT_NEAR(mean, 1, 0.02) << "what lies in the rays was between them";
    }
}

/// Light up to 3, which is above the threshold nearly everywhere.
ReferenceImage lights(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::random_display(width, height, 61);
    for (Rgba& color : picture.pixels) color = {3 * color.r, 3 * color.g, 3 * color.b, color.a};
    return test::round_to_float(picture);
}

TEST(EffectLensFlare, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{128u, 72u}, {131u, 67u}, {1u, 1u}, {9u, 2u}}) {
        const ReferenceImage picture = lights(width, height);
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            for (const LensFlare& flare : {LensFlare{.intensity = 1}, LensFlare{.intensity = 1,
                                                                      .threshold = 0.3f,
                                                                      .ghosts = 16,
                                                                      .spacing = 0.1f,
                                                                      .dispersion = 0.1f,
                                                                      .blades = 5,
                                                                      .starburst = 1,
                                                                      .tint = {0.5f, 1, 2}}}) {
                const ReferenceImage expected = test::reference_of(flare, picture);
                const ReferenceImage out = developed(flare, picture, kernels);
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                // Three writes in half precision, which may be cut off; places of taps, known to 2^-15 of a texel and
                // to a step of the filter, in light of up to 3 of each ghost, twice as bright in a ray.
                const double ghosts = (flare.ghosts + 1) * (1 + double{flare.starburst}) * 4;
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    const double added = expected.pixels[i].g - picture.pixels[i].g;
                    EXPECT_NEAR(out.pixels[i].g, expected.pixels[i].g,
                                added * 0x1p-8 + 1e-5 + ghosts * (0x1p-14 + 3 * gpu::test::filter_step()))
                        << width << "x" << height << ", " << i;
                    EXPECT_EQ(out.pixels[i].a, picture.pixels[i].a);
                }
            }
    }
}

TEST(EffectLensFlare, GpuLeavesDarkPicturesAlone) {
    const ReferenceImage picture = test::round_to_float(test::random_display(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 4, .threshold = 1}, picture), picture), 0);
    const ReferenceImage bright = lights(64, 48);
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, bright), bright), 0);
}

TEST(EffectLensFlare, GpuNanAndInfinityStayContained) {
    test::expect_contained(developed({}, test::grey_with_no_numbers()));
}

TEST(EffectLensFlare, TheSmallPictureHasAsManyTexelsAtEverySize) {
    EXPECT_EQ(bright_part({1280, 720}), 4u);
    EXPECT_EQ(bright_part({1920, 1080}), 4u);
    EXPECT_EQ(bright_part({2560, 1440}), 4u);
    EXPECT_EQ(bright_part({3840, 2160}), 8u);
    EXPECT_EQ(bright_part({7680, 4320}), 16u);
}

TEST(EffectLensFlare, GpuLampsCountAlikeWhereverTheyLie) {
    test::expect_lamps_count_alike(
        [](Composer& composer) {
            composer.add(
                LensFlare{.intensity = 1, .threshold = 0, .ghosts = 1, .halo = 0, .dispersion = 0, .starburst = 0});
        },
        {1, 1, 1});
}

}  // namespace
}  // namespace darkroom
